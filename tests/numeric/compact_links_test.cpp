// SPDX-License-Identifier: Apache-2.0
// What packing links adds to the error of the indirect light, on the links of a whole scene.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <numbers>

#include "city/base/hash.h"
#include "city/format/tile_reader.h"
#include "city/layout/surfaces.h"
#include "city/light/bake_light.h"
#include "city/light/linear_senders.h"
#include "city/light/reference_solver.h"
#include "city/light/sun.h"
#include "city/model/build_nodes.h"
#include "city/pack/writer.h"

using namespace helio;

namespace {

constexpr double kDegree = std::numbers::pi / 180.0;

struct Packed
{
    LinkTable links;
    double bytesPerLink = 0.0;
};

/// The links as a reader of the compact form gets them.
Packed passThroughPack(const LinkTable& links, bool zstd)
{
    std::vector<float> moments;
    for (const glm::vec2& m : links.moment) moments.insert(moments.end(), {m.x, m.y});
    TileView tile;
    tile.linkRows = links.rowBegin;
    tile.linkColumns = links.column;
    tile.linkFactors = links.factor;
    tile.linkMoments = moments;
    const EncodedTile encoded = encodeTile(tile, zstd, true);
    const Result<LoadedTile> loaded = readTile(encoded.bytes, "tile");
    EXPECT_TRUE(loaded.ok()) << (loaded.ok() ? "" : loaded.error().message);
    Packed packed{links, 0.0};
    if (!loaded) return packed;
    packed.links.column.assign(loaded->view.linkColumns.begin(), loaded->view.linkColumns.end());
    packed.links.factor.assign(loaded->view.linkFactors.begin(), loaded->view.linkFactors.end());
    for (size_t k = 0; k < packed.links.moment.size(); ++k)
        packed.links.moment[k] = {loaded->view.linkMoments[2 * k], loaded->view.linkMoments[2 * k + 1]};
    for (const SectionId id : {SectionId::LinkColumns, SectionId::LinkFactors, SectionId::LinkMoments})
        packed.bytesPerLink += double(loaded->storedBytes[u32(id) - 1]) / double(links.column.size());
    return packed;
}

/// Moments as if each link saw its sender around a random point: the mean of `points` centroids of patches below it.
void addMoments(const NodeTree& tree, LinkTable& links, u32 points)
{
    const std::vector<SlopeFrame> frames = slopeFrames(tree);
    links.childSlopes = childSlopes(tree, frames);
    links.moment.assign(links.column.size(), glm::vec2(0.0f));
    Random random(17);
    for (size_t k = 0; k < links.column.size(); ++k) {
        const u32 sender = links.column[k];
        glm::dvec2 offset(0.0);
        for (u32 point = 0; point < points; ++point) {
            u32 below = sender;
            while (!tree.isLeaf(below)) {
                const std::span<const u32> children = tree.childrenOf(below);
                below = children[random.next() % children.size()];
            }
            offset += frames[sender].at(tree.nodes[below].centroid - tree.nodes[sender].centroid) / double(points);
        }
        links.moment[k] = glm::dvec2(double(links.factor[k])) * offset;
    }
}

struct Difference
{
    double rms = 0.0, bias = 0.0; ///< of E_indirect, area weighted, over its mean; the worst of all lights
};

class CompactLinksError : public testing::Test
{
protected:
    void SetUp() override
    {
        const std::string base = std::string(HELIO_TEST_DATA) + "/scenes/S";
        const Result<ShapeTree> shapes = readSurfaces(base + ".obj", base + ".csv");
        ASSERT_TRUE(shapes.ok());
        tree_ = buildNodes(*shapes, {}).tree;
        const Visibility visibility(tree_);
        const u32 n = tree_.patchCount();
        bake_ = bakeLight(tree_, {.formFactorEpsilon = 5e-4});
        for (const auto& [azimuth, elevation] : {std::pair(150.0, 40.0), {235.0, 18.0}, {100.0, 62.0}}) {
            const glm::dvec3 toSun = sunDirection(azimuth * kDegree, elevation * kDegree);
            lights_.emplace_back(n);
            const std::vector<double> sun = raySun(tree_, visibility, toSun, 64);
            for (u32 i = 0; i < n; ++i) lights_.back()[i] = glm::dvec4(800.0 * sun[i]);
        }
        lights_.emplace_back(n);
        for (u32 i = 0; i < n; ++i)
            for (u32 k = bake_.sky.rowBegin[i]; k < bake_.sky.rowBegin[i + 1]; ++k)
                lights_.back()[i] += glm::dvec4(120.0 * double(bake_.sky.factor[k]));
    }

    Difference worst(const LinkTable& exact, const LinkTable& packed) const
    {
        Difference worst;
        const std::vector<glm::dvec4> none(tree_.patchCount(), glm::dvec4(0.0));
        for (const std::vector<glm::dvec4>& light : lights_) {
            const SolveOptions options{.residual = 1e-7};
            const Solution a = solveLight(tree_, exact, light, none, options),
                           b = solveLight(tree_, packed, light, none, options);
            double area = 0.0, mean = 0.0, difference = 0.0, square = 0.0;
            for (u32 i = 0; i < tree_.patchCount(); ++i) {
                const double d = b.indirect[i].y - a.indirect[i].y;
                area += tree_.patches[i].area;
                mean += tree_.patches[i].area * a.indirect[i].y;
                difference += tree_.patches[i].area * d;
                square += tree_.patches[i].area * d * d;
            }
            worst.rms = std::max(worst.rms, std::sqrt(square / area) / (mean / area));
            worst.bias = std::max(worst.bias, std::abs(difference / mean));
        }
        return worst;
    }

    void expectSmall(const char* what, const LinkTable& links, double bytes) const
    {
        const Packed packed = passThroughPack(links, false), smaller = passThroughPack(links, true);
        EXPECT_EQ(packed.links.column, links.column);
        EXPECT_EQ(packed.links.factor, smaller.links.factor) << "zstd takes nothing away";
        const Difference d = worst(links, packed.links);
        std::printf("%s, %zu links: %.2f bytes each, %.2f with zstd; adds rms %.4f %%, bias %.5f %%\n", what,
                    links.column.size(), packed.bytesPerLink, smaller.bytesPerLink, 100 * d.rms, 100 * d.bias);
        EXPECT_LT(packed.bytesPerLink, bytes);
        EXPECT_LT(smaller.bytesPerLink, packed.bytesPerLink);
        EXPECT_LT(d.rms, 1e-3);
        EXPECT_LT(d.bias, 1e-4);
        EXPECT_GT(d.rms, 0.0) << "nothing was packed";
    }

    NodeTree tree_;
    LightBake bake_;
    std::vector<std::vector<glm::dvec4>> lights_;
};

TEST_F(CompactLinksError, ConstantSenders)
{
    LinkTable links = bake_.links;
    links.moment.clear();
    links.childSlopes.clear();
    expectSmall("constant senders", links, 3.5);
}

TEST_F(CompactLinksError, LinearSenders)
{
    LinkTable links = bake_.links;
    expectSmall("linear senders as baked", links, 5.0);
    addMoments(tree_, links, 1); // As far from the mean as can be: the largest codes.
    expectSmall("linear senders, moments of single patches", links, 5.0);
    addMoments(tree_, links, 5);
    expectSmall("linear senders, moments between patches", links, 5.0);
}

TEST_F(CompactLinksError, FewLinksARow)
{
    LightOptions coarse;
    coarse.formFactorEpsilon = 0.006;
    LinkTable links = bakeLight(tree_, coarse).links;
    EXPECT_LT(double(links.column.size()), 12.0 * tree_.patchCount());
    addMoments(tree_, links, 3);
    expectSmall("linear senders, few links", links, 6.0);
}

} // namespace
