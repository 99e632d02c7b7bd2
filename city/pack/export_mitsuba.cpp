// SPDX-License-Identifier: Apache-2.0
#include "city/pack/export_mitsuba.h"

#include <bit>
#include <cstring>
#include <numbers>
#include <span>

#include "city/base/file.h"
#include "city/model/triangulate.h"
#include "city/pack/patch_scene.h"

namespace helio {
namespace {

static_assert(std::endian::native == std::endian::little, "PLY and PFM are written in the machine's order");

constexpr u32 kSkyRows = 2048; // the horizon blurs over one row: 0.09 degrees
constexpr u32 kSkyColumns = 8;

template <class T> void appendBytes(std::string& bytes, const T& value)
{
    char raw[sizeof(T)];
    std::memcpy(raw, &value, sizeof(T));
    bytes.append(raw, sizeof(T));
}

/// The triangles of some patches.
std::string plyText(const TileView& tile, std::span<const u32> patches)
{
    std::string vertices, faces;
    u32 corners = 0, triangles = 0;
    for (const u32 patch : patches) {
        std::vector<Polygon3> polygons;
        const std::vector<Ring3> rings = outlineRings(tile, patch);
        for (size_t r = 0; r < rings.size(); ++r) {
            if ((tile.outlineRings[tile.outlineRows[patch] + r] & 1u) == 0 || polygons.empty())
                polygons.push_back({rings[r], {}});
            else
                polygons.back().holes.push_back(rings[r]);
        }
        for (const Polygon3& polygon : polygons) {
            for (const std::array<u32, 3>& t : triangulate(polygon)) {
                appendBytes(faces, u8(3));
                for (const u32 corner : t) appendBytes(faces, i32(corners + corner));
                ++triangles;
            }
            const auto put = [&](const Ring3& ring) {
                for (const glm::dvec3& p : ring) appendBytes(vertices, glm::vec3(p));
                corners += u32(ring.size());
            };
            put(polygon.outer);
            for (const Ring3& hole : polygon.holes) put(hole);
        }
    }
    return concat("ply\nformat binary_little_endian 1.0\nelement vertex ", corners,
                  "\nproperty float x\nproperty float y\nproperty float z\nelement face ", triangles,
                  "\nproperty list uchar int vertex_indices\nend_header\n") +
           vertices + faces;
}

/// Rows of a PFM file run from below to above, and so does the sky: nadir first.
std::string skyMap(double radiance, const glm::dvec3& farGround)
{
    std::string bytes = concat("PF\n", kSkyColumns, " ", kSkyRows, "\n-1.0\n");
    for (u32 row = 0; row < kSkyRows; ++row)
        for (u32 k = 0; k < 3 * kSkyColumns; ++k)
            appendBytes(bytes, float(row < kSkyRows / 2 ? farGround[int(k % 3)] : radiance));
    return bytes;
}

std::string rgb(const char* name, double r, double g, double b)
{
    std::string text = concat("<rgb name=\"", name, "\" value=\"");
    std::string values;
    for (const double v : {r, g, b}) appendNumber(values, v);
    return text + values.substr(1) + "\"/>";
}

/// A mesh file as a shape. `meter`: the patch that it measures, or none.
std::string shapeText(const std::string& file, u32 material, const Surface6& s, const std::string& id, u32 meter)
{
    std::string text =
        concat("  <shape type=\"ply\" id=\"", id, "\">\n    <string name=\"filename\" value=\"", file,
               "\"/>\n    <boolean name=\"face_normals\" value=\"true\"/>\n    <ref id=\"m", material, "\"/>\n");
    if (s[3] > 0.0f || s[4] > 0.0f || s[5] > 0.0f)
        text += concat("    <emitter type=\"area\">",
                       rgb("radiance", double(s[3]) / std::numbers::pi, double(s[4]) / std::numbers::pi,
                           double(s[5]) / std::numbers::pi),
                       "</emitter>\n");
    // The seed keeps the meters apart: the parser makes one of objects that are alike, and a meter has one shape.
    if (meter != kNoIndex)
        text += concat("    <sensor type=\"irradiancemeter\" id=\"meter_", meter,
                       "\"><film type=\"hdrfilm\"><integer name=\"width\" value=\"1\"/><integer name=\"height\" "
                       "value=\"1\"/><rfilter type=\"box\"/></film><sampler type=\"independent\"><integer "
                       "name=\"sample_count\" value=\"4096\"/><integer name=\"seed\" value=\"",
                       meter, "\"/></sampler></sensor>\n");
    return text + "  </shape>\n";
}

std::string lightText(const SceneLight& light, const glm::dvec3& farGround, const std::string& stem)
{
    std::string text;
    if (light.toSun.z > 0.0 && light.dni > 0.0) {
        text += concat("  <emitter type=\"directional\">\n    ", rgb("irradiance", light.dni, light.dni, light.dni),
                       "\n    <vector name=\"direction\"");
        const char* axes[] = {"x", "y", "z"};
        for (int a = 0; a < 3; ++a) {
            std::string value;
            appendNumber(value, -light.toSun[a]);
            text += concat(" ", axes[a], "=\"", value.substr(1), "\"");
        }
        text += "/>\n  </emitter>\n";
    }
    if (light.dhi > 0.0 || farGround != glm::dvec3(0.0))
        text += concat("  <emitter type=\"envmap\">\n    <string name=\"filename\" value=\"", stem,
                       "_sky.pfm\"/>\n    <transform name=\"to_world\"><rotate x=\"1\" angle=\"90\"/></transform>\n"
                       "  </emitter>\n");
    return text;
}

} // namespace

MitsubaScene exportMitsuba(const Pack& pack, const SceneLight& light, const std::string& stem, u32 meters)
{
    const TileView& tile = pack.tile();
    const u32 patchCount = pack.patchCount();
    std::vector<u8> measured(patchCount, u8(0));
    meters = std::min(meters, patchCount);
    for (u32 k = 0; k < meters; ++k) measured[size_t(u64(k) * patchCount / meters)] = u8(1);

    MitsubaScene scene;
    scene.xml =
        "<?xml version=\"1.0\" encoding=\"utf-8\"?>\n"
        "<!-- metres, z up, +y grid north; light in W/m2 -->\n"
        "<scene version=\"3.0.0\">\n  <integrator type=\"path\">\n    <integer name=\"max_depth\" value=\"-1\"/>\n"
        "    <integer name=\"rr_depth\" value=\"4\"/>\n  </integrator>\n";
    const glm::dvec3 farGround = farGroundRadiance(pack, light);
    scene.xml += lightText(light, farGround, stem);
    std::string shapes;
    u32 material = 0;
    for (const auto& [surface, patches] : patchesByMaterial(tile)) {
        // Mitsuba's diffuse reflector is black from behind.
        scene.xml +=
            concat("  <bsdf type=\"diffuse\" id=\"m", material, "\">",
                   rgb("reflectance", double(surface[0]), double(surface[1]), double(surface[2])), "</bsdf>\n");
        std::vector<u32> together;
        for (const u32 patch : patches) {
            if (measured[patch] == 0) {
                together.push_back(patch);
                continue;
            }
            const std::string file = concat(stem, "_patch_", patch, ".ply");
            scene.files.emplace_back(file, plyText(tile, std::span(&patch, 1)));
            shapes += shapeText(file, material, surface, concat("patch_", patch), patch);
        }
        if (!together.empty()) {
            const std::string file = concat(stem, "_m", material, ".ply");
            scene.files.emplace_back(file, plyText(tile, together));
            shapes += shapeText(file, material, surface, concat("mesh_", material), kNoIndex);
        }
        ++material;
    }
    scene.xml += shapes + "</scene>\n";
    if (light.dhi > 0.0 || farGround != glm::dvec3(0.0))
        scene.files.emplace_back(stem + "_sky.pfm", skyMap(light.dhi / std::numbers::pi, farGround));
    scene.files.emplace_back(stem + "_points.txt", sensorPoints(pack, light.pointsPerPatch));
    return scene;
}

Status writeMitsuba(const Pack& pack, const SceneLight& light, const std::filesystem::path& file, u32 meters)
{
    const MitsubaScene scene = exportMitsuba(pack, light, file.stem().string(), meters);
    // The scene comes last: where it lies, all that it names is there.
    for (const auto& [name, bytes] : scene.files)
        if (Status status = writeTextAtomically(file.parent_path() / name, bytes); !status) return status;
    return writeTextAtomically(file, scene.xml);
}

} // namespace helio
