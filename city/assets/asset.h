// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>
#include <span>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/base/types.h"

namespace helio {

/// A glTF mesh in its own units and axes (glTF: y up). All primitives are merged; colours and materials are kept per
/// vertex.
struct AssetMesh
{
    std::string path; ///< as written in the rule, for example "facade/sill.glb"
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals; ///< unit
    std::vector<glm::vec3> albedos; ///< per vertex, linear: the material's diffuse reflectance for display
    std::vector<bool> isGlass;      ///< per vertex, of a material named "glass": pictures let it reflect the sky
    std::vector<u32> indices;       ///< triangles, counter-clockwise outside
    glm::dvec3 boxMin{0.0}, boxMax{0.0};
    /// Diffuse reflectance (r, g, b, solar) that its front (+z) view shows: area-weighted by projected area, by
    /// material name (glass 0.12), not by display colour.
    glm::dvec4 rho{0.5};
};

/// Loads a .glb. Errors name the file and what is wrong (no mesh, no positions, sparse or Draco data, index out of
/// range).
Result<AssetMesh> loadAsset(const std::filesystem::path& file, const std::string& nameInRule);

/// The same from the bytes of a .glb; `file` stands for the file in messages. The baker carries the shipped assets
/// inside.
Result<AssetMesh> parseAsset(std::span<const std::byte> glb, const std::string& file, const std::string& nameInRule);

/// The asset of a name written in a rule: `folder / name`, else an error that lists where it was looked for.
Result<std::filesystem::path> findAsset(const std::string& nameInRule,
                                        const std::vector<std::filesystem::path>& folders);

} // namespace helio
