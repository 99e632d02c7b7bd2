// SPDX-License-Identifier: Apache-2.0
#include "tests/numeric/solution_scenes.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <glm/geometric.hpp>
#include <glm/packing.hpp>
#include <numbers>
#include <optional>

#include "city/light/bake_light.h"
#include "city/light/form_factor.h"
#include "city/light/path_tracer.h"
#include "city/light/reference_solver.h"
#include "city/sky/sky_model.h"
#include "tests/numeric/exact_light.h"
#include "tests/numeric/text_table.h"

namespace helio::test {
namespace {

constexpr double kPi = std::numbers::pi;

struct Canyon
{
    double heightOverWidth, rhoGround, rhoWall;
};

std::optional<Canyon> canyonOf(const std::string& id)
{
    const std::map<std::string, Canyon> canyons{
        {"W03", {0.5, 0.2, 0.3}}, {"W04", {1.0, 0.2, 0.3}}, {"W05", {2.0, 0.2, 0.3}}, {"W07", {1.0, 0.5, 0.5}}};
    const auto found = canyons.find(id);
    return found == canyons.end() ? std::nullopt : std::optional(found->second);
}

/// A CIE sky on a small plane below obstructions that run along y: it is seen at profile angles from `from` to `to`.
struct SkyRow
{
    u32 cieType;
    glm::dvec3 normal;
    double from, to;
};

SkyRow skyRowOf(const std::string& id)
{
    const double edge = std::atan(2.0);
    const std::map<std::string, SkyRow> rows{{"W11", {16, {1, 0, 0}, 0.0, kPi / 2}},
                                             {"W12", {16, {1, 0, 0}, 25.0 * kPi / 180.0, kPi / 2}},
                                             {"W14", {16, {0, 0, 1}, edge, kPi - edge}},
                                             {"W15", {1, {1, 0, 0}, 0.0, kPi / 2}}};
    const auto found = rows.find(id);
    EXPECT_NE(found, rows.end()) << "no scene for row " << id;
    return found == rows.end() ? rows.begin()->second : found->second;
}

/// Irradiance by Simpson's rule over the profile angle psi and the angle tau to the plane across the obstructions.
double profileIrradiance(const SkyShape& sky, const glm::dvec3& normal, double from, double to, u32 intervals)
{
    const auto weight = [&](u32 k) { return k == 0 || k == intervals ? 1.0 : k % 2 == 1 ? 4.0 : 2.0; };
    double sum = 0.0;
    for (u32 i = 0; i <= intervals; ++i)
        for (u32 k = 0; k <= intervals; ++k) {
            const double psi = from + (to - from) * i / intervals, tau = kPi * (double(k) / intervals - 0.5);
            const glm::dvec3 d(std::cos(tau) * std::cos(psi), std::sin(tau), std::cos(tau) * std::sin(psi));
            sum += weight(i) * weight(k) * sky(d) * (d.x * normal.x + d.z * normal.z) * std::cos(tau);
        }
    return sum * (to - from) * kPi / (9.0 * intervals * intervals);
}

Quantities skyExactly(const std::string& id, u32 n)
{
    const SkyRow row = skyRowOf(id);
    const SkyShape sky = cieSky(row.cieType, {0, 0, 1});
    const double ratio = profileIrradiance(sky, row.normal, row.from, row.to, 2 * n) /
                         profileIrradiance(sky, {0, 0, 1}, 0.0, kPi, 2 * n);
    return {{"E_v/E_h", ratio}, {"E/E_h", ratio}};
}

/// Corners k / n of an edge, closer together towards its ends.
std::vector<double> graded(u32 n)
{
    std::vector<double> at(n + 1);
    for (u32 k = 0; k <= n; ++k) at[k] = 0.5 - 0.5 * std::cos(kPi * k / n);
    return at;
}

std::vector<double> evenly(u32 n)
{
    std::vector<double> at(n + 1);
    for (u32 k = 0; k <= n; ++k) at[k] = double(k) / n;
    return at;
}

/// A parallelogram cut at the given fractions of its edges.
void addCut(std::vector<Face>& faces, const glm::dvec3& corner, const glm::dvec3& u, const glm::dvec3& v,
            const std::vector<double>& atU, const std::vector<double>& atV, const Face& like)
{
    for (size_t j = 0; j + 1 < atV.size(); ++j)
        for (size_t i = 0; i + 1 < atU.size(); ++i) {
            Face face = like;
            const auto at = [&](size_t a, size_t b) { return corner + atU[a] * u + atV[b] * v; };
            face.ring = {at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)};
            faces.push_back(face);
        }
}

/// The six sides of a room as in room(), cut at the same fractions.
std::vector<Face> cutRoom(const glm::dvec3& size, const std::vector<double>& at)
{
    const glm::dvec3 x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z), o(0.0);
    std::vector<Face> faces;
    addCut(faces, o, x, y, at, at, {{}, 0});
    addCut(faces, z, y, x, at, at, {{}, 1});
    addCut(faces, o, y, z, at, at, {{}, 2});
    addCut(faces, x, z, y, at, at, {{}, 3});
    addCut(faces, o, z, x, at, at, {{}, 4});
    addCut(faces, y, x, z, at, at, {{}, 5});
    return faces;
}

std::vector<Face> cube(const std::vector<double>& at)
{
    std::vector<Face> faces = cutRoom({1, 1, 1}, at);
    for (Face& face : faces) {
        face.rho = glm::dvec4(0.5);
        face.emission = glm::dvec4(face.group == 0 ? 1.0 : 0.0);
    }
    return faces;
}

std::vector<Face> courtyard(const std::vector<double>& at)
{
    std::vector<Face> faces = cutRoom({20, 20, 15}, at);
    for (Face& face : faces) face.rho = glm::dvec4(face.group == 0 ? 0.2 : 0.3);
    return faces;
}

std::vector<double> areasOf(const std::vector<Face>& faces)
{
    std::vector<double> areas;
    for (const Face& face : faces) areas.push_back(planarShape({{face.ring}}).area);
    return areas;
}

/// Means over the sides of a room of which each has the same number of patches.
Quantities roomMeans(const std::vector<double>& areas, const std::vector<double>& radiosity, size_t perSide)
{
    return {{"floor mean radiosity", meanOf(areas, radiosity, 0, perSide)},
            {"ceiling mean radiosity", meanOf(areas, radiosity, perSide, 2 * perSide)},
            {"wall mean radiosity", meanOf(areas, radiosity, 2 * perSide, 6 * perSide)}};
}

Quantities roomExactly(std::vector<Face> faces, size_t perSide, bool open)
{
    if (open) // the opening: black, and as bright as the sky
        for (size_t i = perSide; i < 2 * perSide; ++i) {
            faces[i].rho = glm::dvec4(0.0);
            faces[i].emission = glm::dvec4(1.0);
        }
    const std::vector<double> factors = exactFactors(faces), areas = areasOf(faces);
    std::vector<double> rho, emission;
    for (const Face& face : faces) {
        rho.push_back(face.rho.x);
        emission.push_back(face.emission.x);
    }
    const std::vector<double> radiosity = solveDense(factors, rho, emission);
    Quantities result = roomMeans(areas, radiosity, perSide);
    double out = 0.0, opening = 0.0;
    for (size_t i = perSide; i < 2 * perSide; ++i) {
        opening += areas[i];
        for (size_t j = 0; j < faces.size(); ++j) out += areas[i] * factors[i * faces.size() + j] * radiosity[j];
    }
    result["courtyard albedo (flux out / flux in)"] = out / opening;
    return result;
}

Quantities canyonExactly(const Canyon& canyon, u32 n)
{
    const double h = canyon.heightOverWidth;
    std::vector<Strip> strips;
    const auto add = [&](const glm::dvec2& from, const glm::dvec2& to, u32 parts) {
        const std::vector<double> at = evenly(parts);
        for (u32 k = 0; k < parts; ++k) strips.push_back({from + at[k] * (to - from), from + at[k + 1] * (to - from)});
    };
    add({0, 0}, {1, 0}, n);
    add({1, 0}, {1, h}, n);
    add({0, h}, {0, 0}, n);
    add({1, h}, {0, h}, 1); // the sky
    const std::vector<double> factors = crossedStrings(strips);
    std::vector<double> rho(strips.size(), canyon.rhoWall), emission(strips.size(), 0.0), lengths;
    std::fill(rho.begin(), rho.begin() + n, canyon.rhoGround);
    rho.back() = 0.0;
    emission.back() = 1.0;
    for (const Strip& strip : strips) lengths.push_back(glm::distance(strip.a, strip.b));
    const std::vector<double> radiosity = solveDense(factors, rho, emission);
    double albedo = 0.0;
    for (size_t j = 0; j < strips.size(); ++j) albedo += factors[3 * n * strips.size() + j] * radiosity[j];
    return {{"ground mean radiosity", meanOf(lengths, radiosity, 0, n)},
            {"wall mean radiosity", meanOf(lengths, radiosity, n, 3 * n)},
            {"canyon albedo", albedo}};
}

/// What the bake and the solver make of a scene under a sky of DHI 1 W/m2.
struct Baked
{
    NodeTree tree;
    std::vector<double> areas, sky, radiosity;
};

/// Radiance of a cell in the middle of what a patch sees of it (SkyTable::offset).
double radianceAt(const CellSky& cell, u32 offset)
{
    const glm::dvec2 place = 0.5 * glm::dvec2(glm::unpackSnorm2x16(offset));
    return cell.mean + glm::dot(cell.slope, place);
}

Baked bakeScene(const std::vector<Face>& faces, u32 skyPatches, const std::vector<CellSky>& radiance)
{
    Baked out;
    out.tree = makeTree(faces);
    LightOptions options;
    options.skyPatches = skyPatches;
    const LightBake bake = bakeLight(out.tree, options);
    const u32 n = out.tree.patchCount();
    std::vector<glm::dvec4> sun(n, glm::dvec4(0.0)), sky(n, glm::dvec4(0.0));
    for (u32 i = 0; i < n; ++i) {
        double sum = 0.0;
        for (u32 k = bake.sky.rowBegin[i]; k < bake.sky.rowBegin[i + 1]; ++k)
            sum += kPi * double(bake.sky.factor[k]) *
                   radianceAt(radiance[bake.sky.column[k]], bake.sky.offset.empty() ? 0u : bake.sky.offset[k]);
        out.sky.push_back(sum);
        sky[i] = glm::dvec4(sum);
    }
    const Solution solution = solveLight(out.tree, bake.links, sun, sky, {});
    for (u32 i = 0; i < n; ++i) {
        out.areas.push_back(out.tree.patches[i].area);
        out.radiosity.push_back(solution.radiosity[i].x);
    }
    return out;
}

/// Share of the light that comes through an opening under a uniform sky which leaves through it again.
double albedoOf(const Baked& baked, size_t begin, size_t end, double opening)
{
    double out = 0.0;
    for (size_t i = begin; i < end; ++i) out += baked.areas[i] * baked.sky[i] * baked.radiosity[i];
    return out / opening;
}

constexpr double kCanyonWidth = 10.0, kCanyonLength = 5000.0;

/// Ground, western and eastern wall; patches run across first, so any stretch is one block of their numbers.
std::vector<Face> canyonFaces(const Canyon& canyon, u32 partsAcross, u32 partsAlong)
{
    const std::vector<double> across = graded(partsAcross), along = evenly(partsAlong);
    const glm::dvec3 x(kCanyonWidth, 0, 0), y(0, kCanyonLength, 0), z(0, 0, canyon.heightOverWidth * kCanyonWidth);
    std::vector<Face> faces;
    addCut(faces, {0, 0, 0}, x, y, across, along, {{}, 0, glm::dvec4(canyon.rhoGround)});
    addCut(faces, z, -z, y, across, along, {{}, 1, glm::dvec4(canyon.rhoWall)});
    addCut(faces, x, z, y, across, along, {{}, 2, glm::dvec4(canyon.rhoWall)});
    return faces;
}

Quantities canyonBaked(const Canyon& canyon)
{
    constexpr u32 kAcross = 18, kAlong = 15, kMiddle = 9;
    const Baked baked = bakeScene(canyonFaces(canyon, kAcross, kAlong), 1, {{1.0 / kPi}});
    const size_t side = size_t(kAcross) * kAlong, middle = size_t(kAlong - kMiddle) / 2 * kAcross,
                 count = size_t(kMiddle) * kAcross;
    const auto mean = [&](size_t face) {
        return meanOf(baked.areas, baked.radiosity, face * side + middle, face * side + middle + count);
    };
    double albedo = 0.0;
    for (size_t face = 0; face < 3; ++face)
        albedo += albedoOf(baked, face * side + middle, face * side + middle + count,
                           kCanyonWidth * kCanyonLength * kMiddle / kAlong);
    return {{"ground mean radiosity", mean(0)},
            {"wall mean radiosity", 0.5 * (mean(1) + mean(2))},
            {"canyon albedo", albedo}};
}

Quantities skyBaked(const std::string& id, u32 skyPatches)
{
    // 64 pieces of a small plane, so that the noise of their rays is small too; the obstructions are 2 km long.
    const SkyRow row = skyRowOf(id);
    constexpr double kSize = 0.01, kFar = 10.0, kHalf = 1000.0;
    std::vector<Face> faces;
    if (row.normal.x > 0.0) {
        append(faces, grid({0, 0, 0}, {0, kSize, 0}, {0, 0, kSize}, 8, 8, {{}, 0}));
    } else {
        append(faces, grid({-kSize / 2, 0, 0}, {kSize, 0, 0}, {0, kSize, 0}, 8, 8, {{}, 0}));
        append(faces, grid({-kFar, -kHalf, 0}, {0, 2 * kHalf, 0}, {0, 0, kFar * std::tan(row.from)}, 1, 1, {{}, 1}));
    }
    if (row.from > 0.0)
        append(faces, grid({kFar, kHalf, 0}, {0, -2 * kHalf, 0}, {0, 0, kFar * std::tan(row.from)}, 1, 1, {{}, 2}));
    for (Face& face : faces) face.rho = glm::dvec4(0.0);
    const SkyDome dome(skyPatches);
    const Baked baked = bakeScene(faces, skyPatches, domeRadiance(dome, cieSky(row.cieType, {0, 0, 1}), 1.0));
    const double ratio = meanOf(baked.areas, baked.sky, 0, 64);
    return {{"E_v/E_h", ratio}, {"E/E_h", ratio}};
}

} // namespace

std::string sceneOf(const std::string& id)
{
    return id == "W09" || id == "W10" ? "W05" : id;
}

std::vector<SolutionRow> solutionRows(const std::string& dataFolder)
{
    std::vector<SolutionRow> rows;
    for (const std::vector<std::string>& cells : readTextTable(dataFolder + "/closed_forms/solutions.csv"))
        rows.push_back({cells[0], cells[2], cells[3].empty() ? std::nan("") : std::strtod(cells[3].c_str(), nullptr),
                        std::strtod(cells[4].c_str(), nullptr)});
    return rows;
}

Quantities solveExactly(const std::string& scene, u32 n)
{
    if (const std::optional<Canyon> canyon = canyonOf(scene)) return canyonExactly(*canyon, n);
    if (scene == "W01") return roomExactly(cube(evenly(n)), size_t(n) * n, false);
    if (scene == "W02") return roomExactly(courtyard(evenly(n)), size_t(n) * n, true);
    return skyExactly(scene, n);
}

Quantities solveBaked(const std::string& scene, u32 skyPatches)
{
    constexpr u32 kCuts = 10;
    constexpr size_t kPerSscenee = size_t(kCuts) * kCuts;
    if (const std::optional<Canyon> canyon = canyonOf(scene)) return canyonBaked(*canyon);
    if (scene == "W01") {
        const Baked baked = bakeScene(cube(graded(kCuts)), 1, {{0.0}});
        return roomMeans(baked.areas, baked.radiosity, kPerSscenee);
    }
    if (scene != "W02") return skyBaked(scene, skyPatches);
    std::vector<Face> faces = courtyard(graded(kCuts));
    faces.erase(faces.begin() + kPerSscenee, faces.begin() + 2 * kPerSscenee); // open above
    const Baked baked = bakeScene(faces, 1, {{1.0 / kPi}});
    return {{"floor mean radiosity", meanOf(baked.areas, baked.radiosity, 0, kPerSscenee)},
            {"wall mean radiosity", meanOf(baked.areas, baked.radiosity, kPerSscenee, 5 * kPerSscenee)},
            {"courtyard albedo (flux out / flux in)", albedoOf(baked, 0, 5 * kPerSscenee, 400.0)}};
}

std::map<std::string, Traced> solveTraced(const std::string& scene, u32 samples)
{
    std::vector<Face> faces;
    size_t stride = 1, first = 0; // one patch a face, or the middle of three
    double opening = 0.0;         // m2
    if (const std::optional<Canyon> canyon = canyonOf(scene)) {
        faces = canyonFaces(*canyon, 1, 3);
        stride = 3;
        first = 1;
        opening = kCanyonWidth * kCanyonLength / 3.0;
    } else if (scene == "W01") {
        faces = cube(evenly(1));
    } else {
        faces = courtyard(evenly(1));
        faces.erase(faces.begin() + 1);
        opening = 400.0;
    }
    const NodeTree tree = makeTree(faces);
    const Visibility visibility(tree);
    const PathReference paths = tracePaths(tree, visibility, {.dni = 0.0, .dhi = 1.0, .samples = samples});
    const auto radiosity = [&](std::initializer_list<size_t> sides) {
        Traced mean;
        for (const size_t side : sides) {
            const PatchLight& light = paths.patches[side * stride + first];
            const Patch& patch = tree.patches[side * stride + first];
            mean.value += (patch.emission.x + patch.rho.x * (light.sky.x + light.indirect.x)) / double(sides.size());
            mean.error = std::hypot(mean.error, patch.rho.x * light.totalError.x / double(sides.size()));
        }
        return mean;
    };
    if (scene == "W01")
        return {{"floor mean radiosity", radiosity({0})},
                {"ceiling mean radiosity", radiosity({1})},
                {"wall mean radiosity", radiosity({2, 3, 4, 5})}};
    Traced albedo{1.0, 0.0};
    for (size_t i = first; i < faces.size(); i += stride) {
        const PatchLight& light = paths.patches[i];
        const double share = tree.patches[i].area * (1.0 - tree.patches[i].rho.x) / opening;
        albedo.value -= share * (light.sky.x + light.indirect.x);
        albedo.error = std::hypot(albedo.error, share * light.totalError.x);
    }
    if (scene == "W02")
        return {{"floor mean radiosity", radiosity({0})},
                {"wall mean radiosity", radiosity({1, 2, 3, 4})},
                {"courtyard albedo (flux out / flux in)", albedo}};
    return {{"ground mean radiosity", radiosity({0})},
            {"wall mean radiosity", radiosity({1, 2})},
            {"canyon albedo", albedo}};
}

} // namespace helio::test
