// SPDX-License-Identifier: Apache-2.0
#include "city/layout/heights.h"

#include <algorithm>
#include <glm/geometric.hpp>

#include "city/layout/box_grid.h"

namespace helio {

namespace {

double medianOf(std::vector<double> values)
{
    const auto middle = values.begin() + long(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

} // namespace

void fillMissingHeights(std::vector<Footprint>& footprints, const ImportOptions& options, ImportNotes& notes)
{
    BoxGrid grid(std::max(options.neighbourRadius, 10.0));
    std::vector<glm::dvec2> centres;
    for (u32 f = 0; f < footprints.size(); ++f) {
        const Box2 box = boxOf(footprints[f].outline.outer);
        centres.push_back(0.5 * (box.low + box.high));
        if (footprints[f].height > 0.0) grid.insert({centres[f], centres[f]}, f);
    }
    std::vector<double> heights; // filled in at the end: a guess is nobody's neighbour
    for (u32 f = 0; f < footprints.size(); ++f) {
        heights.push_back(footprints[f].height);
        if (heights[f] > 0.0) continue;
        std::vector<double> near;
        if (options.neighbourRadius > 0.0)
            for (const u32 other : grid.touching(Box2{centres[f], centres[f]}.grown(options.neighbourRadius)))
                if (glm::distance(centres[other], centres[f]) <= options.neighbourRadius)
                    near.push_back(footprints[other].height);
        notes.count(near.empty() ? "height.default" : "height.neighbours");
        heights[f] = near.empty() ? options.defaultHeight : medianOf(std::move(near));
    }
    for (u32 f = 0; f < footprints.size(); ++f) footprints[f].height = heights[f];
}

} // namespace helio
