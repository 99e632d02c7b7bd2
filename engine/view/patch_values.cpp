// SPDX-License-Identifier: Apache-2.0
#include "engine/view/patch_values.h"

#include <algorithm>

#include "city/base/check.h"

namespace helio {

std::vector<glm::vec4> patchLevels(const TileView& tile)
{
    std::vector<u32> depth(tile.nodes.size(), 0);
    // Parents come after their children.
    for (size_t i = tile.nodes.size(); i-- > 0;)
        if (tile.nodes[i].parent != kNoIndex) depth[i] = depth[tile.nodes[i].parent] + 1;
    std::vector<glm::vec4> levels;
    for (size_t i = 0; i < tile.patches.size(); ++i) levels.emplace_back(float(depth[i]), 0.0f, 0.0f, 1.0f);
    return levels;
}

std::vector<glm::vec4> linksOfPatch(const TileView& tile, u32 picked)
{
    HELIO_CHECK(picked < tile.patches.size(), picked, " of ", tile.patches.size(), " patches");
    std::vector<double> perArea(tile.nodes.size(), 0.0);
    for (u32 node = picked; node != kNoIndex; node = tile.nodes[node].parent)
        for (u32 k = tile.linkRows[node]; k < tile.linkRows[node + 1]; ++k) {
            const u32 sender = tile.linkColumns[k];
            if (tile.nodes[sender].area > 0.0f)
                perArea[sender] += double(tile.linkFactors[k]) / double(tile.nodes[sender].area);
        }
    for (size_t i = tile.nodes.size(); i-- > 0;)
        if (tile.nodes[i].parent != kNoIndex) perArea[i] += perArea[tile.nodes[i].parent];
    const double largest = *std::max_element(perArea.begin(), perArea.begin() + long(tile.patches.size()));
    std::vector<glm::vec4> values;
    for (size_t i = 0; i < tile.patches.size(); ++i)
        values.emplace_back(float(i == picked ? std::max(largest, 1e-30) : perArea[i]), 0.0f, 0.0f, 1.0f);
    return values;
}

std::vector<glm::vec4> expectedErrors(const TileView& tile, std::span<const glm::vec4> indirect)
{
    if (tile.patchErrors.empty()) return {};
    HELIO_CHECK(indirect.size() == tile.patches.size(), indirect.size(), " of ", tile.patches.size(), " patches");
    double sum = 0.0, area = 0.0;
    for (size_t i = 0; i < indirect.size(); ++i) {
        sum += double(tile.patches[i].area) * double(indirect[i].a);
        area += double(tile.patches[i].area);
    }
    const double mean = area > 0.0 ? sum / area : 0.0;
    std::vector<glm::vec4> values;
    for (const float share : tile.patchErrors) values.emplace_back(float(double(share) * mean), 0.0f, 0.0f, 1.0f);
    return values;
}

} // namespace helio
