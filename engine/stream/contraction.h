// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <vector>

#include "city/format/pack.h"

namespace helio {

/// What the links to each patch and to its ancestors add up to: the fraction of the light that leaves the patch which
/// other patches receive. 1 minus it goes to the sky and out of the scene.
std::vector<double> linkSums(const TileView& tile);

/// The same for the absolute values of the factors between patches that the links stand for: an upper bound of them.
/// Constant senders: sum |F|. A linear sender stands for factors F + M . X(p) to its patches p, weighted by area, where
/// X has mean 0 and variance 1 without correlation. If none of them can be negative they add up to F; otherwise, by
/// the inequality of Cauchy and Schwarz, to at most sqrt(F^2 + |M|^2).
std::vector<double> absoluteLinkSums(const TileView& tile);

/// How much of an error in the radiosity a sweep can leave, in the maximum norm.
struct Contraction
{
    /// The largest reflectance x absoluteLinkSums of a patch, a channel. Below 1 every sweep shrinks the largest error
    /// by at least this factor, and change / (1 - number) bounds the error.
    glm::dvec4 number{0.0};
    u32 patch = 0;                           ///< that has the largest number of all channels
    double reflectance = 0.0, linkSum = 0.0; ///< its factors

    double largest() const { return reflectance * linkSum; }
};
Contraction contractionOf(const TileView& tile);

} // namespace helio
