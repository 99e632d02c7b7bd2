// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <string>
#include <vector>

#include "city/light/light_tables.h"
#include "city/light/predicted_error.h"
#include "city/model/build_nodes.h"

namespace helio {

/// How links are chosen and weighed.
enum class LinkMethod : u8
{
    Heliopolis, ///< no cut-off, form factor x visibility, refined by the error that a link leaves (city/README.md,
                ///< "Decisions")
    Paper, ///< the source paper's algorithms, repaired: form factor threshold, cut-off by box distance, no visibility
    PaperLiteral ///< as printed: centre distance, the wrong node is refined, pairs that refine a leaf are lost
};

/// What bakeLight does; a zero epsilon, number of rays, of sky patches or of jobs means "choose".
struct LightOptions
{
    LinkMethod method = LinkMethod::Heliopolis;
    /// Heliopolis: the error of E_indirect to aim at, rms over the mean, on any sun: chooses how far patches are split,
    /// the links' epsilon and the rays. > 0; every halving costs about 1.5 times the links.
    double error = 0.02;
    /// Heliopolis: the irradiance error that one link may leave in a patch of mean size, as a fraction of the scene's
    /// mean radiosity. Paper methods: the largest form factor of a link. Smaller = more links, more time. 0 = by
    /// `error`, or the paper's default.
    double formFactorEpsilon = 0.0;
    /// Heliopolis: largest number of patches after splitting / before; 1 = none is split, however wrong.
    double splitGrowth = 5.0;
    /// Heliopolis: a link sees its sender's mean radiosity alone (the paper's way), not its slope too.
    bool constantSenders = false;
    bool leafReceivers = false; ///< Heliopolis: links end at patches alone (rows without push-down)
    u32 raysPerPatch = 0; ///< sky rays of a patch; 0 = by `error` and the number of patches, 256 to 1024; planes of few
                          ///< patches shoot more (scanSky)
    u32 skyPatches = 1;   ///< cells of the sky's dome; 1 = for uniform skies only, 0 = autoSkyPatches
    /// Reflectance of an endless plain beyond the scene, a last sky patch; 0 = the scene ends in the void.
    glm::dvec4 farGround{0.0};
    u32 raysPerLink =
        0; ///< visibility rays of a pair of parts where a link is seen in part (it has up to 64 such); 0 = 2
    double cutoff = 22.5; ///< m, paper methods only: no link beyond (1.5 x a street of 15 m); 0 = none
    u32 jobs = 0;         ///< threads; 0 = all cores. The result does not depend on it.
    u64 seed = 1;
    std::function<void(const char* step, double done)>
        progress{}; ///< may be empty; called from one thread at a time, done in 0..1
};

struct MinMeanMax
{
    double min = 0.0, mean = 0.0, max = 0.0; ///< the mean is area weighted
};

struct StepSeconds
{
    std::string step;
    double seconds = 0.0;
};

/// What a bake says about itself.
struct LightStats
{
    u64 linkCount = 0;              ///< directed links
    double linksPerPatch = 0.0;     ///< linkCount / patches
    u32 wholePatchCount = 0;        ///< patches before splitting
    u32 splitPatchCount = 0;        ///< and after it
    double unresolved = 0.0;        ///< SplitPlan::unresolved
    PredictedError predicted;       ///< of E_indirect; 0 for the paper methods, whose error no estimate knows
    u32 rootPairCount = 0;          ///< pairs of planar roots that may see each other
    u64 pairsEvaluated = 0;         ///< node pairs that the oracle looked at
    double formFactorEpsilon = 0.0; ///< as used: the option or the method's default
    u32 raysPerPatch = 0;           ///< as used
    bool farGround = false;         ///< what leaves below the horizon meets a plain that sends light back
    u32 raysPerLink = 0;            ///< as used; 0 for the paper methods, which shoot none
    /// Patches of which more than 1 % of the rays meet back sides: walls against a neighbour's wall or inside a solid.
    /// What they see hangs on the order of coincident faces; the sums below leave them out.
    u32 insidePatchCount = 0;
    double insideAreaShare = 0.0; ///< their share of the area of all patches, 0..1
    /// Patches that a neighbour covers: no links, no sky; left out of the sums below and of the number inside.
    u32 coveredPatchCount = 0;
    double coveredAreaShare = 0.0; ///< their share of the area of all patches, 0..1
    MinMeanMax
        closure; ///< per patch: links (own and ancestors') + sky + escape below the horizon + back sides; 1 = closed
    MinMeanMax rowSum;          ///< per patch: links, own and ancestors'
    MinMeanMax rayRowSum;       ///< per patch: fraction of its rays that hit a lit side
    MinMeanMax sky;             ///< per patch: fraction of its rays that reach the sky
    MinMeanMax below;           ///< per patch: fraction of its rays that leave below the horizon
    double closureDefect = 0.0; ///< mean(rowSum) / mean(rayRowSum) - 1; more than 1 % away from 0 means missing senders
    std::vector<StepSeconds> seconds;
};

struct LightBake
{
    LinkTable links;
    SkyTable sky;
    LightStats stats;
};

/// Computes what light does in a city once, for every sun and every sky: the links between nodes and the patches' view
/// of the sky. Deterministic: the same tree and options give the same bytes for any number of jobs. Aborts
/// (HELIO_CHECK) on a tree whose areas or indices are not valid.
LightBake bakeLight(const NodeTree& tree, const LightOptions& options);

/// The same, with patches split first where light varies inside them (splitPatches). `assets` as for buildNodes.
LightBake bakeLight(NodeTreeBuild& build, std::span<const AssetSummary> assets, const LightOptions& options);

} // namespace helio
