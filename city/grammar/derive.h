// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

#include "city/grammar/limits.h"
#include "city/grammar/rules.h"
#include "city/model/footprint.h"
#include "city/model/shape_tree.h"

namespace helio {

/// Bounding box of an asset in its own units and axes (glTF: y up).
struct AssetBox
{
    glm::dvec3 min{0.0}, max{0.0};
};

/// What a derivation depends on besides rules and footprints.
struct DeriveOptions
{
    u64 seed = 0;
    u32 jobs = 0;                  ///< threads; 0 = all cores. The result does not depend on it
    u64 maxSteps = cga::kMaxSteps; ///< work of one building: evaluated terms, operations, corners; more is an error
    /// Values of rule attributes for all buildings; they win over a footprint's own properties.
    std::map<std::string, Attribute> attributes;
    /// Box of the asset that i("name") inserts. Called from several threads but never twice at once, once per name.
    /// Empty: i() is refused.
    std::function<Result<AssetBox>(const std::string& name)> assetBox;
    /// Told how many buildings of how many are done. Called from several threads but never twice at once; may be empty.
    std::function<void(u32 done, u32 total)> progress;
    /// Asked between buildings, in the same way: true stops the derivation with an error.
    std::function<bool()> interrupted;
};

/// Roofs that were built, and those that had to be simplified (see RoofFallback).
struct RoofCounts
{
    u64 roofs = 0; ///< all of them
    u64 parts = 0; ///< of them, those of a simpler kind
    u64 flat = 0;  ///< of them, those without a slope
};

/// What a derivation made.
struct DeriveCounts
{
    u64 shapes = 0;          ///< nodes of the tree
    u64 leaves = 0;          ///< of them, those with polygons or an asset
    u64 coveredLeaves = 0;   ///< of them, those on walls that a neighbour covers
    u64 droppedOpenings = 0; ///< assets that were left out because a neighbour covers their wall
    RoofCounts roofs;
};

/// The derivation of a whole city.
struct Derivation
{
    ShapeTree shapes;                      ///< buildings in the order of the footprints, parents before children
    std::map<std::string, double> reports; ///< report(key, value), summed per key
    std::vector<std::string> warnings;     ///< one line each, every text once; the first 1000
    DeriveCounts counts;
};

/// Derives all footprints. Building i is footprint i; a footprint without any leaf has only its root. A footprint with
/// faces (a given building model) starts from them: each runs the rule WallSurface, RoofSurface or GroundSurface.
/// Errors (`file:line:column: building 'id': ...`, that of the first building that has one): a value of the wrong type,
/// a size that is not finite, a repeat without extent, a missing asset, and the limits of limits.h; an interruption.
/// Same bytes for any number of jobs. Every random draw hangs on seed, building id, path in the tree and rule name.
/// Buildings are added to the tree in their order as soon as they are done: besides the result, only a bounded number
/// of them is in memory.
Result<Derivation> derive(const RuleSet& rules, std::span<const Footprint> footprints, const DeriveOptions& options);

} // namespace helio
