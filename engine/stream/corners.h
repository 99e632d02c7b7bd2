// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <vector>

#include "city/base/types.h"
#include "shaders/shared/records.h"

namespace helio {

/// Corners that coplanar patches share, for interpolated light in pictures.
struct Corners
{
    std::vector<u32> ofVertex; ///< a vertex of the static mesh
    std::vector<u32> rows;     ///< corners + 1 offsets into patches
    std::vector<u32> patches;  ///< of each corner, ascending, each once
};

/// Joins vertices with the same position (to 1 mm) and normal. Triangle corners of other patches that lie inside an
/// edge (T-junctions) count as corners of the edge's patch too.
Corners buildCorners(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices);

} // namespace helio
