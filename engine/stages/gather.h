// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>
#include <optional>
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
    Ref<Buffer> radiosity;  ///< a node: B
    Ref<Buffer> irradiance; ///< a node: what arrives over links; at the patches E_indirect
    Ref<Buffer> slopes;     ///< linear senders only: two an inner node, of B in the node's slope coordinates
};

/// Before the sweeps: B0, and B = B0 + rho E_indirect with the E_indirect of the last solve (warm) or none (cold),
/// pulled up.
LightRefs addFirstLight(FrameGraph& graph, const TileTables& tile, const DirectLight& direct, LightRefs light,
                        bool emission, bool warm);

/// X_parent = sum A_child X_child / A_parent, level by level, in place (vec4 a node).
[[nodiscard]] Ref<Buffer> addPull(FrameGraph& graph, const TileTables& tile, Ref<Buffer> values,
                                  const std::string& name = "pull");
/// addPull of the radiosity, with linear senders of its slopes too.
[[nodiscard]] LightRefs addPullLight(FrameGraph& graph, const TileTables& tile, LightRefs light);
/// E_child += E_parent, level by level, in place (vec4 a node).
[[nodiscard]] Ref<Buffer> addPush(FrameGraph& graph, const TileTables& tile, Ref<Buffer> values);
/// E_i = sum F_ij B_j over the links of row i, at every node; with linear senders sum F_ij B_j + M_ij . slope_j.
[[nodiscard]] LightRefs addGather(FrameGraph& graph, const TileTables& tile, LightRefs light);

struct UpdateRefs
{
    LightRefs light;
    Ref<Buffer> residual; ///< ResidualRecord
};
/// What Chebyshev's semi-iteration needs beside a sweep.
struct ChebyshevRefs
{
    Ref<Buffer> before;     ///< vec4 a patch: the radiosity before the sweep before; kept up by the sweeps
    glm::vec4 weight{1.0f}; ///< see chebyshevWeight; a channel of weight 1 makes a plain sweep
};
/// One Jacobi sweep: gather, push, B = B0 + rho E at the patches, pull; and the sums of the residual of the B before.
/// partials: scratch, updateGroups(tile) ResidualRecords.
UpdateRefs addSweep(FrameGraph& graph, const TileTables& tile, LightRefs light, Ref<Buffer> partials,
                    Ref<Buffer> residual, const std::optional<ChebyshevRefs>& chebyshev = {});

/// Work groups of the update, one partial sum each.
u32 updateGroups(const TileTables& tile);

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
