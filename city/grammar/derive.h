// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <glm/vec3.hpp>
#include <map>
#include <span>
#include <string>
#include <vector>

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
    u32 jobs = 0; ///< threads; 0 = all cores. The result does not depend on it
    /// Values of rule attributes for all buildings; they win over a footprint's own properties.
    std::map<std::string, Attribute> attributes;
    /// Box of the asset that i("name") inserts. Called from several threads but never twice at once, once per name.
    /// Empty: i() is refused.
    std::function<Result<AssetBox>(const std::string& name)> assetBox;
};

/// The derivation of a whole city.
struct Derivation
{
    ShapeTree shapes;                      ///< buildings in the order of the footprints, parents before children
    std::map<std::string, double> reports; ///< report(key, value), summed per key
    std::vector<std::string> warnings;     ///< one line each, every text once
};

/// Derives all footprints. Building i is footprint i; a footprint without any leaf has only its root.
/// Errors (`file:line:column: building 'id': ...`, that of the first building that has one): a value of the wrong type,
/// a size that is not finite, a repeat without extent, a missing asset, and the limits of limits.h. Same bytes for any
/// number of jobs. Every random draw hangs on seed, building id, path in the tree and rule name.
Result<Derivation> derive(const RuleSet& rules, std::span<const Footprint> footprints, const DeriveOptions& options);

} // namespace helio
