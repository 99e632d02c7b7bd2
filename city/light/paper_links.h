// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/light/links.h"

namespace helio {

struct PaperOptions
{
    double epsilon = 0.0; ///< largest form factor of a link, MIN_FORM_FACTOR in the paper; > 0
    double cutoff = 22.5; ///< m, MIN_DISTANCE in the paper: 1.5 x a street of 15 m; 0 = none
    bool literal = false; ///< as printed: see paperLinks
};

/// Fraction of what leaves `from` that reaches `to` by the disc estimate A cos cos / (pi d^2 + A) between centroids,
/// without visibility, 0..1; the areas are the nodes' own, so their coverage does not enter. Not reciprocal: what near
/// nodes of different size exchange differs by the direction it is estimated in.
double discFactor(const Node& from, const Node& to);

/// The links of the source paper (Algorithms 1 and 2) over all pairs of planar roots, without visibility.
/// Repaired: pairs whose boxes are farther apart than the cut-off are dropped; the node that is large as seen from the
/// other is refined; a leaf sends the refinement to the other node; two leaves are linked. Literal: the distance is
/// that of the centroids, the *first* node is refined where F12 is large (the second is what looks large), and where
/// the node to refine is a leaf the pair is lost. Each direction keeps its own estimate. Order of work: pairs of roots
/// within the cut-off along x, found by a sweep; without a cut-off all pairs, O(n^2).
std::vector<NodeLink> paperLinks(const NodeTree& tree, const PaperOptions& options);

} // namespace helio
