// SPDX-License-Identifier: Apache-2.0
#include "city/pack/export_radiance.h"

#include <cmath>
#include <numbers>
#include <utility>

#include "city/base/file.h"
#include "city/pack/patch_scene.h"
#include "city/pack/single_ring.h"

namespace helio {
namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSunDegrees = 0.05; // small enough for sharp shadows, large enough for Radiance's floats
constexpr double kGlowShare = 0.01;  // of an emitting patch's mixture

/// `void plastic NAME` without gloss.
void appendDiffuse(std::string& text, const std::string& name, double r, double g, double b)
{
    text += concat("void plastic ", name, "\n0\n0\n5");
    for (const double v : {r, g, b, 0.0, 0.0}) appendNumber(text, v);
    text += "\n";
}

void appendMaterial(std::string& text, const std::string& name, const Surface6& s)
{
    const bool emits = s[3] > 0.0f || s[4] > 0.0f || s[5] > 0.0f;
    // What glow takes of the mixture, the reflecting part gets back.
    const double scale = emits ? 1.0 / (1.0 - kGlowShare) : 1.0;
    appendDiffuse(text, name + "_front", scale * double(s[0]), scale * double(s[1]), scale * double(s[2]));
    std::string front = name + "_front";
    if (emits) {
        text += concat("void glow ", name, "_glow\n0\n0\n4");
        for (int c = 3; c < 6; ++c) appendNumber(text, double(s[size_t(c)]) / kPi / kGlowShare);
        text += concat(" 0\nvoid mixfunc ", name, "_lit\n4 ", name, "_glow ", front, " ", kGlowShare, " .\n0\n0\n");
        front = name + "_lit";
    }
    // Rdot > 0: the ray comes from the side where the corners run counter-clockwise.
    text += concat("void mixfunc ", name, "\n4 ", front, " black if(Rdot,1,0) .\n0\n0\n");
}

void appendPolygon(std::string& text, const std::string& material, u32 patch, const Ring3& ring)
{
    text += concat(material, " polygon p", patch, "\n0\n0\n", 3 * ring.size());
    for (const glm::dvec3& corner : ring)
        for (int a = 0; a < 3; ++a) appendNumber(text, corner[a]);
    text += "\n";
}

std::string lightText(const SceneLight& light, const glm::dvec3& farGround)
{
    std::string text = "# sun and sky, W/m2/sr\n";
    if (light.toSun.z > 0.0 && light.dni > 0.0) {
        const double half = 0.5 * kSunDegrees * kPi / 180.0;
        const double radiance = light.dni / (kPi * std::sin(half) * std::sin(half));
        text += "void light sun_light\n0\n0\n3";
        for (int c = 0; c < 3; ++c) appendNumber(text, radiance);
        text += "\nsun_light source sun\n0\n0\n4";
        for (const double v : {light.toSun.x, light.toSun.y, light.toSun.z, kSunDegrees}) appendNumber(text, v);
        text += "\n";
    }
    if (light.dhi > 0.0) {
        text += "void glow sky_glow\n0\n0\n4";
        for (int c = 0; c < 3; ++c) appendNumber(text, light.dhi / kPi);
        text += " 0\nsky_glow source sky\n0\n0\n4 0 0 1 180\n";
    }
    if (farGround != glm::dvec3(0.0)) {
        text += "# the ground beyond the scene, in the sun and under the sky\nvoid glow ground_glow\n0\n0\n4";
        for (int c = 0; c < 3; ++c) appendNumber(text, farGround[c]);
        text += " 0\nground_glow source ground\n0\n0\n4 0 0 -1 180\n";
    }
    return text;
}

} // namespace

RadianceText exportRadiance(const Pack& pack, const SceneLight& light)
{
    const TileView& tile = pack.tile();
    RadianceText text;
    text.scene = "# metres, z up, +y grid north; polygon pK = patch K\n";
    appendDiffuse(text.scene, "black", 0.0, 0.0, 0.0);
    u32 material = 0;
    for (const auto& [surface, patches] : patchesByMaterial(tile)) {
        const std::string name = concat("m", material++);
        appendMaterial(text.scene, name, surface);
        for (const u32 i : patches)
            appendPolygon(text.scene, name, i, joinRings(outlineRings(tile, i), glm::dvec3(tile.patches[i].normal)));
    }
    text.light = lightText(light, farGroundRadiance(pack, light));
    text.points = sensorPoints(pack, light.pointsPerPatch);
    text.readme = concat(
        pack.patchCount(), " patches. Line K x ", light.pointsPerPatch,
        " + i (from 0) of points.txt and of the result is ",
        "point i of patch K; the mean over a patch's points is its irradiance, W/m2, red green blue (sun, sky and all\n"
        "bounces; for E_indirect subtract the same run with -ab 1, which holds the sun and the sky alone where nothing "
        "emits).\n\n"
        "oconv light.rad scene.rad > scene.oct\n"
        "rtrace -I+ -h -n 2 -ab 16 -ad 1024 -aa 0 -as 0 -lr -20 -lw 2e-6 -dt 0 -dc 1 -dj 0 -dv- -u+ scene.oct "
        "< points.txt > irradiance.txt\n");
    return text;
}

Status writeRadiance(const Pack& pack, const SceneLight& light, const std::filesystem::path& folder)
{
    std::error_code failure;
    std::filesystem::create_directories(folder, failure);
    if (failure) return Error{concat(folder.string(), ": the folder cannot be made: ", failure.message())};
    const RadianceText text = exportRadiance(pack, light);
    for (const auto& [name, content] : {std::pair{"scene.rad", &text.scene},
                                        {"light.rad", &text.light},
                                        {"points.txt", &text.points},
                                        {"README.txt", &text.readme}})
        if (Status status = writeTextAtomically(folder / name, *content); !status) return status;
    return Nothing{};
}

} // namespace helio
