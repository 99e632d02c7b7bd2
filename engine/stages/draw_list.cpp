// SPDX-License-Identifier: Apache-2.0
#include "engine/stages/draw_list.h"

#include <cstddef>
#include <cstring>

#include "shaders/shared/sun.h"

namespace helio {

DrawList::DrawList(Context& context, std::vector<gpu::DrawRecord> draws)
    : draws_(std::make_shared<const std::vector<gpu::DrawRecord>>(std::move(draws))),
      arguments_(context, {"draws", std::max<u64>(draws_->size(), 1) * sizeof(gpu::DrawRecord), Memory::Upload})
{
    // No draws is a null pointer, which memcpy must not get.
    if (!draws_->empty()) std::memcpy(arguments_.mapped(), draws_->data(), draws_->size() * sizeof(gpu::DrawRecord));
    arguments_.flush();
}

u64 DrawList::triangleCount() const
{
    u64 count = 0;
    for (const gpu::DrawRecord& draw : *draws_) count += u64(draw.indexCount / 3) * draw.instanceCount;
    return count;
}

CityMesh::CityMesh(PassBuilder& pass, const TileTables& tile, const DrawList& list)
    : CityMesh(pass, tile.vertices, tile.indices, tile.instances, list)
{
}

CityMesh::CityMesh(PassBuilder& pass, const Buffer& vertices, const Buffer& indices, const Buffer& instances,
                   const DrawList& list)
    : vertices_(pass.read(pass.import(vertices), Use::VertexAttribute)),
      indices_(pass.read(pass.import(indices), Use::Index)),
      instances_(pass.read(pass.import(instances), Use::VertexAttribute)),
      arguments_(pass.read(pass.import(list.arguments()), Use::Indirect)), draws_(list.draws())
{
}

void CityMesh::describe(GraphicsPipelineDesc& desc, bool shading)
{
    using gpu::InstanceRecord;
    using gpu::VertexRecord;
    constexpr u32 kRow = sizeof(glm::vec4);
    desc.vertexSlots = {{sizeof(VertexRecord), false}, {sizeof(InstanceRecord), true}};
    desc.attributes = {
        {gpu::kAttributePosition, 0, VK_FORMAT_R32G32B32_SFLOAT, offsetof(VertexRecord, position)},
        {gpu::kAttributePatch, 0, VK_FORMAT_R32_UINT, offsetof(VertexRecord, patchId)},
        {gpu::kAttributeRow0, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(InstanceRecord, worldFromLocal)},
        {gpu::kAttributeRow1, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(InstanceRecord, worldFromLocal) + kRow},
        {gpu::kAttributeRow2, 1, VK_FORMAT_R32G32B32A32_SFLOAT, offsetof(InstanceRecord, worldFromLocal) + 2 * kRow},
        {gpu::kAttributeInstancePatch, 1, VK_FORMAT_R32_UINT, offsetof(InstanceRecord, patchId)},
    };
    // Packed values are read as words and unpacked by the shader: signed ten-bit vertex formats are optional.
    desc.attributes.push_back({gpu::kAttributeNormal, 0, VK_FORMAT_R32_UINT, offsetof(VertexRecord, normal)});
    if (!shading) return;
    desc.attributes.push_back({gpu::kAttributeAlbedo, 0, VK_FORMAT_R32_UINT, offsetof(VertexRecord, albedo)});
}

void CityMesh::draw(const PassContext& context, Drawing& drawing) const
{
    if (count() == 0) return;
    drawing.vertices(0, vertices_);
    drawing.vertices(1, instances_);
    drawing.indices(indices_);
    if (context.context().facts().drawIndirectFirstInstance) {
        drawing.drawIndexedIndirect(arguments_, 0, count());
        return;
    }
    for (const gpu::DrawRecord& draw : *draws_)
        drawing.drawIndexed(draw.indexCount, draw.instanceCount, draw.firstIndex, i32(draw.vertexOffset),
                            draw.firstInstance);
}

} // namespace helio
