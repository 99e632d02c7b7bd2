// SPDX-License-Identifier: Apache-2.0
#include "tests/numeric/lit_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <glm/geometric.hpp>

#include "city/light/sun.h"

namespace helio::test {

double LitScene::flux(const std::function<double(u32 patch)>& value) const
{
    double sum = 0.0;
    for (u32 i = 0; i < tree.patchCount(); ++i) sum += tree.patches[i].area * value(i);
    return sum;
}

double LitScene::mean(const std::function<double(u32 patch)>& value, const std::function<bool(u32 patch)>& which) const
{
    double area = 0.0, sum = 0.0;
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        if (!which(i)) continue;
        area += tree.patches[i].area;
        sum += tree.patches[i].area * value(i);
    }
    return area > 0.0 ? sum / area : 0.0;
}

LitScene lightScene(NodeTree tree, const Daylight& daylight)
{
    LitScene scene;
    scene.tree = std::move(tree);
    scene.bake = bakeLight(scene.tree, {.error = 0.005});
    const u32 n = scene.tree.patchCount();
    const Visibility visibility(scene.tree);
    scene.sun = raySun(scene.tree, visibility, daylight.toSun, 256);
    std::vector<glm::dvec4> sun(n), sky(n);
    for (u32 i = 0; i < n; ++i) {
        scene.sun[i] *= daylight.dni;
        double share = 0.0;
        for (u32 k = scene.bake.sky.rowBegin[i]; k < scene.bake.sky.rowBegin[i + 1]; ++k)
            share += double(scene.bake.sky.factor[k]);
        scene.sky.push_back(daylight.dhi * share);
        sun[i] = glm::dvec4(scene.sun[i]);
        sky[i] = glm::dvec4(scene.sky[i]);
    }
    scene.solution = solveLight(scene.tree, scene.bake.links, sun, sky, {.residual = 1e-6, .maxSweeps = 1000});
    return scene;
}

LitScene lightFaces(const std::vector<Face>& faces, const Daylight& daylight)
{
    return lightScene(makeTree(faces), daylight);
}

void expectPhysical(const LitScene& scene, const Daylight& daylight)
{
    const NodeTree& tree = scene.tree;
    glm::dvec4 brightest(0.0);
    for (u32 i = 0; i < tree.patchCount(); ++i) brightest = glm::max(brightest, scene.solution.radiosity[i]);
    for (u32 i = 0; i < tree.patchCount(); ++i) {
        const double cosine = std::max(0.0, glm::dot(tree.nodes[i].normal, daylight.toSun));
        EXPECT_TRUE(scene.sun[i] >= 0.0 && scene.sun[i] <= daylight.dni * cosine * (1.0 + 1e-12)) << i;
        EXPECT_TRUE(scene.sky[i] >= 0.0 && scene.sky[i] <= daylight.dhi * (1.0 + 1e-6)) << i << ": " << scene.sky[i];
        for (u32 c = 0; c < 4; ++c) {
            const double e = scene.solution.indirect[i][c];
            EXPECT_TRUE(e >= 0.0 && e <= 1.03 * brightest[c]) << i << ": " << e << " of " << brightest[c];
        }
    }
    for (u32 c = 0; c < 4; ++c) {
        double came = 0.0, sent = 0.0, arrived = 0.0, absorbed = 0.0;
        for (u32 i = 0; i < tree.patchCount(); ++i) {
            const Patch& patch = tree.patches[i];
            const double direct = scene.sun[i] + scene.sky[i], indirect = scene.solution.indirect[i][c];
            came += patch.area * (direct + patch.emission[c]);
            sent += patch.area * scene.solution.radiosity[i][c];
            arrived += patch.area * indirect;
            absorbed += patch.area * (1.0 - patch.rho[c]) * (direct + indirect);
        }
        EXPECT_TRUE(std::isfinite(came + sent + arrived + absorbed));
        EXPECT_LE(arrived, 1.01 * sent) << "channel " << c;
        EXPECT_LE(absorbed, 1.01 * came) << "channel " << c;
    }
}

std::vector<Face> boxOutside(const glm::dvec3& low, const glm::dvec3& high, double cell, u32 firstGroup)
{
    const glm::dvec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    const auto parts = [cell](double length) { return std::max(1u, u32(std::lround(length / cell))); };
    const u32 nx = parts(size.x), ny = parts(size.y), nz = parts(size.z);
    std::vector<Face> faces = grid(low, x, z, nx, nz, {{}, firstGroup});
    append(faces, grid(low + x, y, z, ny, nz, {{}, firstGroup + 1}));
    append(faces, grid(low + x + y, -x, z, nx, nz, {{}, firstGroup + 2}));
    append(faces, grid(low + y, -y, z, ny, nz, {{}, firstGroup + 3}));
    append(faces, grid(low + z, x, y, nx, ny, {{}, firstGroup + 4}));
    return faces;
}

std::vector<Face> turned(std::vector<Face> faces, double angle)
{
    const double c = std::cos(angle), s = std::sin(angle);
    for (Face& face : faces)
        for (glm::dvec3& p : face.ring) p = {c * p.x - s * p.y, s * p.x + c * p.y, p.z};
    return faces;
}

} // namespace helio::test
