// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <string>

#include "engine/graph/frame_graph.h"
#include "engine/stream/tile_tables.h"

namespace helio {

/// First-hand light of every patch, vec4 each, W/m2.
struct DirectLight
{
    Ref<Buffer> sun, sky;
};

/// What the sweeps work on. All vec4, W/m2.
struct LightRefs
{
    Ref<Buffer> b0;         ///< a patch: emission + rho (E_sun + E_sky)
    Ref<Buffer> senders;    ///< B of patches and inner nodes, with slopes: see shaders/shared/solve.h
    Ref<Buffer> irradiance; ///< a node: what arrives over links, its ancestors' included; at the patches E_indirect
};

/// Before the sweeps: B0, and B = B0 + rho E_indirect with the E_indirect of the last solve (warm) or none (cold),
/// pulled up.
LightRefs addFirstLight(FrameGraph& graph, const TileTables& tile, const DirectLight& direct, LightRefs light,
                        bool emission, bool warm);

/// X_parent = sum A_child X_child / A_parent, level by level, in place (vec4 a node).
[[nodiscard]] Ref<Buffer> addPull(FrameGraph& graph, const TileTables& tile, Ref<Buffer> values,
                                  const std::string& name = "pull");
/// addPull of an array of senders, with linear ones of the slopes too.
[[nodiscard]] Ref<Buffer> addPullSenders(FrameGraph& graph, const TileTables& tile, Ref<Buffer> senders);
/// E_i = E_parent + sum F_ij B_j over the links of row i, at every node; with linear senders sum F_ij B_j + M_ij .
/// slope_j.
[[nodiscard]] LightRefs addGather(FrameGraph& graph, const TileTables& tile, LightRefs light);
/// The same over any links, alone.
struct GatherOptions
{
    std::string name = "gather";
    float scale = 1.0f; ///< of the result
    Reads reads = Reads::Texels;
};
[[nodiscard]] Ref<Buffer> addGather(FrameGraph& graph, const LinkBuffers& links, Ref<Buffer> senders,
                                    Ref<Buffer> irradiance, const GatherOptions& options);

/// What a sweep writes beside the light.
struct SweepTargets
{
    Ref<Buffer> senders;  ///< a second array of senders, which takes the new B
    Ref<Buffer> parts;    ///< scratch, residualParts(tile) ResidualRecords
    Ref<Buffer> residual; ///< ResidualRecord
};
struct SweepResult
{
    LightRefs light;    ///< with the new senders
    SweepTargets spent; ///< the old senders, to be written by the next sweep
};
/// One Jacobi sweep: the gather downwards, B = B0 + rho E at the patches, pull; and the sums of the residual of the B
/// before. weight: of Chebyshev's semi-iteration (see chebyshevWeight), for which `to` holds the B before the last one;
/// a channel of weight 1 makes a plain sweep.
SweepResult addSweep(FrameGraph& graph, const TileTables& tile, LightRefs light, SweepTargets to,
                     glm::vec4 weight = glm::vec4(1.0f));

/// Lanes that add up the residual, one part each.
u32 residualParts(const TileTables& tile);

/// ||B_new - B|| / ||B_new - B0||, area weighted, of the channel where it is largest; 0 when nothing is reflected.
double residualOf(const gpu::ResidualRecord& sums);
/// What is still missing from B after a sweep, on the scale of residualOf, in the worst channel: residual q / (1 - q).
/// Plain sweeps: if the steps go on shrinking as they did between the last two, q = ||step|| / ||step before||; large
/// when they do not shrink. Chebyshev, in channels of a radius > 0: q = the radius, which bounds the eigenvalues.
double remainingErrorOf(const gpu::ResidualRecord& before, const gpu::ResidualRecord& sums,
                        const glm::dvec4& radius = glm::dvec4(0.0));
/// largest |B_new - B| / (1 - contraction), W/m2, a channel. No patch of the B that the sweep started from is further
/// from the solution; B_new, and the E that made it, are off by at most the contraction number, and the patch's row
/// sum, times this. Rigorous in exact arithmetic; infinite where the contraction number is 1 or more.
glm::dvec4 errorBoundOf(const gpu::ResidualRecord& sums, const glm::dvec4& contraction);

} // namespace helio
