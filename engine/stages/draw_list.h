// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <memory>
#include <utility>
#include <vector>

#include "engine/graph/pass_context.h"
#include "engine/stream/tile_tables.h"

namespace helio {

/// Draws of one view, in host memory and as arguments of indirect draws. Must live until the device has executed them.
class DrawList
{
public:
    DrawList() = default;
    DrawList(Context& context, std::vector<gpu::DrawRecord> draws);

    const Buffer& arguments() const { return arguments_; }
    std::shared_ptr<const std::vector<gpu::DrawRecord>> draws() const { return draws_; }
    u64 triangleCount() const;

private:
    std::shared_ptr<const std::vector<gpu::DrawRecord>> draws_;
    Buffer arguments_;
};

/// What one view draws.
struct FacingLists
{
    DrawList closed; ///< of closed surfaces: their fronts alone
    DrawList open;   ///< from both sides

    FacingLists() = default;
    FacingLists(Context& context, FacingDraws draws)
        : closed(context, std::move(draws.closed)), open(context, std::move(draws.open))
    {
    }
};

/// Geometry in one pass, declared as vertex, index and indirect input.
class CityMesh
{
public:
    CityMesh(PassBuilder& pass, const TileTables& tile, const DrawList& list);
    CityMesh(PassBuilder& pass, const Buffer& vertices, const Buffer& indices, const Buffer& instances,
             const DrawList& list);

    /// Vertex slots and attributes of every mesh pipeline (shaders/lib/mesh.glsl); with shading also the albedo.
    static void describe(GraphicsPipelineDesc& desc, bool shading);
    u32 count() const { return u32(draws_->size()); }
    /// Draws the list: indirect (many draws in one call where the device can) or, when the device has no instance
    /// offsets in indirect draws, one by one. Barriers: none, the graph's.
    void draw(const PassContext& context, Drawing& drawing) const;

private:
    Ref<Buffer> vertices_, indices_, instances_, arguments_;
    std::shared_ptr<const std::vector<gpu::DrawRecord>> draws_;
};

} // namespace helio
