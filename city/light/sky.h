// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <utility>

#include "city/light/light_tables.h"
#include "city/light/visibility.h"
#include "city/sky/sky_dome.h"

namespace helio {

/// Where the cosine-distributed rays of each patch end, and what follows from that.
struct SkyScan
{
    std::vector<float> sky;    ///< per patch: fraction that leaves above the horizon = sky view factor of a uniform sky
    std::vector<float> below;  ///< per patch: fraction that leaves below the horizon
    std::vector<float> rowSum; ///< per patch: fraction that meets a lit side
    std::vector<float> back;   ///< per patch: fraction that meets a back side, or a covered patch: black
    SkyTable links; ///< from the cells of the dome, and from the ground beyond; a row sums to `sky`, or `sky` + `below`
    /// Pairs (a < b) of planar roots of which at least one patch's ray met the other, ascending: the candidates for
    /// links.
    std::vector<std::pair<u32, u32>> rootPairs;
};

/// Planar root above each node (itself for a root); kNoIndex for clusters.
std::vector<u32> planarRoots(const NodeTree& tree);

/// Number of cells of the sky's dome that a bake takes for 0: 48, and 24 beyond 200,000 patches (city/sky/README.md).
u32 autoSkyPatches(u32 patchCount);

/// Covered patches have no rays: all their fractions are 0 and no pair comes of them. Traces `rays` per patch (more
/// where the plane of the patch would shoot less than 1024), stratified together over its area and over the hemisphere
/// (Sobol points, shifted by a hash of the seed and the patch id). Rays that leave above the horizon are counted by the
/// dome's cells, with their mean place in them. Where `farGround`, the reflectance of an endless plain beyond the
/// scene, is not 0, those that leave below it are links from a last sky patch. `progress` gets the fraction done and
/// may be empty; it is called from one thread at a time.
SkyScan scanSky(const NodeTree& tree, const Visibility& visibility, u32 rays, u64 seed, u32 jobs,
                const std::function<void(double)>& progress, const SkyDome& dome = SkyDome(1),
                const glm::dvec4& farGround = glm::dvec4(0.0));

} // namespace helio
