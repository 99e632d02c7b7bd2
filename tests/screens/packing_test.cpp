// SPDX-License-Identifier: Apache-2.0
// What the short form of links does to the light of whole baked scenes, and how the gather's variants agree on them.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/screens/test_packs.h"

namespace helio {
namespace {

LightTables solve(TestPack which, const UploadOptions& upload)
{
    const Pack& pack = testPack(which);
    RendererOptions options;
    options.upload = upload;
    options.solve.exactSweeps = 8;
    auto renderer = Renderer::create(testContext(), pack, options);
    EXPECT_TRUE(renderer.ok());
    (*renderer)->setSun(150.0, 40.0, 800.0);
    (*renderer)->solve();
    return (*renderer)->readTables();
}

/// rms difference over the mean, weighted by area, of the channel where it is largest.
double difference(const TileView& tile, const std::vector<glm::vec4>& a, const std::vector<glm::vec4>& b)
{
    double worst = 0.0;
    for (int c = 0; c < 4; ++c) {
        double square = 0.0, mean = 0.0, area = 0.0;
        for (size_t i = 0; i < a.size(); ++i) {
            const double weight = double(tile.patches[i].area);
            square += weight * std::pow(double(a[i][c]) - double(b[i][c]), 2.0);
            mean += weight * double(a[i][c]);
            area += weight;
        }
        worst = std::max(worst, std::sqrt(square / area) / (mean / area));
    }
    return worst;
}

class Packing : public testing::TestWithParam<TestPack>
{
};

TEST_P(Packing, AddsLittleToTheErrorOfTheLinks)
{
    const TileView& tile = testPack(GetParam()).tile();
    const LightTables exact = solve(GetParam(), {.exactLinks = true}), packed = solve(GetParam(), {});
    const double indirect = difference(tile, exact.indirect, packed.indirect);
    RecordProperty("E_indirect", std::to_string(indirect));
    EXPECT_LT(indirect, 1.5e-3) << "of links that err by a hundredth";
    EXPECT_GT(indirect, 0.0);
    EXPECT_LT(difference(tile, exact.sky, packed.sky), 1e-4) << "columns of the sky are few, its factors precise";
}

TEST_P(Packing, HoweverTheArraysAreRead)
{
    const LightTables texels = solve(GetParam(), {.reads = Reads::Texels});
    for (const Reads reads : {Reads::Images, Reads::Storage}) {
        const LightTables other = solve(GetParam(), {.reads = reads});
        EXPECT_EQ(texels.sun, other.sun);
        EXPECT_EQ(texels.sky, other.sky);
        EXPECT_EQ(texels.indirect, other.indirect) << int(reads);
        EXPECT_EQ(texels.radiosity, other.radiosity) << int(reads);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Packing, testing::Values(TestPack::City, TestPack::SceneS),
                         [](const auto& scene) { return scene.param == TestPack::City ? "City" : "SceneS"; });

} // namespace
} // namespace helio
