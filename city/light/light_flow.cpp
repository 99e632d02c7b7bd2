// SPDX-License-Identifier: Apache-2.0
#include "city/light/light_flow.h"

#include "city/base/parallel.h"

namespace helio {

NodeLight darkLight(const NodeTree& tree, const LinkTable& links)
{
    NodeLight light;
    light.mean.assign(tree.nodeCount(), glm::dvec4(0.0));
    if (!links.moment.empty()) light.slopeX = light.slopeY = light.mean;
    return light;
}

void pullUp(const NodeTree& tree, const LinkTable& links, NodeLight& light)
{
    for (u32 i = tree.patchCount(); i < tree.nodeCount(); ++i) { // children have smaller numbers than their parents
        const Node& node = tree.nodes[i];
        glm::dvec4 flux(0.0), x(0.0), y(0.0);
        for (u32 k = node.childBegin; k < node.childBegin + node.childCount; ++k) {
            const u32 child = tree.children[k];
            const double area = tree.nodes[child].area;
            flux += area * light.mean[child];
            if (light.slopeX.empty()) continue;
            const gpu::ChildSlopeRecord& s = links.childSlopes[k];
            x += area * (double(s.offsetX) * light.mean[child] + double(s.xx) * light.slopeX[child] +
                         double(s.xy) * light.slopeY[child]);
            y += area * (double(s.offsetY) * light.mean[child] + double(s.yx) * light.slopeX[child] +
                         double(s.yy) * light.slopeY[child]);
        }
        light.mean[i] = flux / node.area;
        if (light.slopeX.empty()) continue;
        light.slopeX[i] = x / node.area;
        light.slopeY[i] = y / node.area;
    }
}

void gatherLight(const NodeTree& tree, const LinkTable& links, const NodeLight& light, u32 jobs,
                 std::vector<glm::dvec4>& irradiance)
{
    const bool linear = !links.moment.empty();
    irradiance.resize(tree.nodeCount());
    parallelFor(tree.nodeCount(), 4096, jobs, [&](u32 begin, u32 end) {
        for (u32 i = begin; i < end; ++i) {
            glm::dvec4 sum(0.0);
            for (u32 k = links.rowBegin[i]; k < links.rowBegin[i + 1]; ++k) {
                const u32 sender = links.column[k];
                sum += double(links.factor[k]) * light.mean[sender];
                if (linear)
                    sum += double(links.moment[k].x) * light.slopeX[sender] +
                           double(links.moment[k].y) * light.slopeY[sender];
            }
            irradiance[i] = sum;
        }
    });
    for (u32 i = tree.nodeCount(); i-- > 0;)
        if (const u32 parent = tree.nodes[i].parent; parent != kNoIndex) irradiance[i] += irradiance[parent];
}

} // namespace helio
