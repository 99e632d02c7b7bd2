// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "city/geometry/wavefront.h"

namespace helio {

/// What is wrong with the faces of a skeleton, or empty: every arc once in each direction, faces simple and
/// counter-clockwise over their edge, times >= 0 and equal to the distance from the edge over its speed, areas of all
/// faces `area` (grid steps squared) within 1e-6. Lengths in grid steps; corner i and edges[i].next are the first two
/// nodes of face i.
std::string skeletonProblem(std::span<const WaveEdge> edges, std::span<const WaveNode> nodes,
                            std::span<const std::vector<u32>> faces, Real area);

} // namespace helio
