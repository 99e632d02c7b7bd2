// SPDX-License-Identifier: Apache-2.0
// The stages once more in plain C++ and double precision: what the device's results are compared with.
#pragma once
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <vector>

#include "city/format/pack.h"

namespace helio::twin {

/// Texels of each id below patchCount.
std::vector<u32> countIds(std::span<const u32> ids, u32 patchCount);

/// Radiosity of every node, and its slopes with linear senders (city/light/linear_senders.h; zero at the patches).
struct NodeLight
{
    std::vector<glm::dvec4> mean, slopeX, slopeY;
};

/// One row's sum of F B + M . slope, and of the absolute values of its terms.
struct RowSum
{
    glm::dvec4 sum{0.0}, absolute{0.0};
};
std::vector<RowSum> gather(const TileView& tile, const NodeLight& light);

/// Area-weighted means of the leaves' values at every node. values: a patch each.
std::vector<glm::dvec4> pullUp(const TileView& tile, std::span<const glm::dvec4> values);
/// The same with the slopes that the patches' values have over each inner node; none with constant senders.
NodeLight pullLight(const TileView& tile, std::span<const glm::dvec4> values);
/// At every node, the sum of its own value and of those of all its ancestors.
std::vector<glm::dvec4> pushDown(const TileView& tile, std::span<const glm::dvec4> values);

/// E_sun of each patch by the rules of city/README.md: own ratio, or that of the smallest ancestor with enough samples.
struct SunEnergy
{
    std::vector<glm::dvec4> irradiance;
    u32 lit = 0, flagged = 0, excess = 0;
};
SunEnergy sunEnergy(const TileView& tile, std::span<const u32> counts, glm::dvec3 towardsSun, double dni,
                    double texelArea, double minSamples, double minCosine);

/// Jacobi sweeps B = B0 + rho F B from B = B0; or, in the channels of a radius > 0, those of Chebyshev's semi-iteration
/// for eigenvalues of [-radius, radius]. Residual: see residualOf in engine/stages/gather.h.
struct Solution
{
    std::vector<glm::dvec4> indirect, radiosity; ///< a patch each
    double residual = 0.0;
    glm::dvec4 largest{0.0}; ///< |B0 + rho F B - B| of the last sweep, of the patch where it is largest
};
Solution solve(const TileView& tile, std::span<const glm::dvec4> b0, u32 sweeps,
               const glm::dvec4& radius = glm::dvec4(0.0));

} // namespace helio::twin
