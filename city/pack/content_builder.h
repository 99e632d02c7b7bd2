// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/assets/asset.h"
#include "city/light/bake_light.h"
#include "city/model/build_nodes.h"
#include "city/pack/content.h"

namespace helio {

/// What one tile can hold.
struct ContentLimits
{
    size_t corners = size_t(1) << 31;  ///< of all outlines: outlineRings keeps one bit for holes
    size_t vertices = size_t(1) << 31; ///< a draw's vertexOffset is signed on the GPU
    size_t indices = 0xFFFFFFFFu;      ///< 32 bits of DrawRecord::firstIndex
};

/// Puts a node tree, its links and the meshes of its assets into the form of the pack. `assets` has one entry an asset
/// of the derivation, in its order. Draw 0 is the static mesh (instance 0): the pieces of all patches that no asset
/// fills, each with its own reflectance as albedo, recesses, and assets that are trimmed; then comes one draw for each
/// asset that has whole instances. Of `index` only the bounds are set. Error: the city has more geometry than one tile
/// can hold.
Result<PackContent> buildContent(const NodeTreeBuild& build, std::span<const AssetMesh> assets, LightBake light,
                                 const ContentLimits& limits = {});

} // namespace helio
