// SPDX-License-Identifier: Apache-2.0
// Stage 3 against the double-precision twin, within the bound of a sequential float sum; and its parts.
#include "engine/stages/gather.h"

#include <cmath>
#include <glm/common.hpp>

#include "city/base/hash.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage_twins.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

constexpr double kUnit = 0x1.0p-24; // rounding of one float operation, relative

const glm::vec4 kGrey(0.5f, 0.25f, 0.125f, 0.75f);

/// Patches and a tree over them: groups of five, groups of those, one root.
TileBuilder makeTree(u32 patchCount, u64 seed)
{
    TileBuilder b;
    Random random(seed);
    for (u32 i = 0; i < patchCount; ++i)
        b.patch({0, 0, 1}, float(0.1 + random.uniform()), glm::vec4(float(random.uniform()), 0.5f, 0.25f, 0.125f),
                glm::vec4(float(random.uniform())));
    std::vector<u32> level;
    for (u32 i = 0; i < patchCount; ++i) level.push_back(i);
    while (level.size() > 1) {
        std::vector<u32> next;
        for (size_t i = 0; i < level.size(); i += 5)
            next.push_back(b.group({level.begin() + long(i), level.begin() + long(std::min(i + 5, level.size()))}));
        level = next;
    }
    return b;
}

std::vector<glm::vec4> randomLight(u32 count, u64 seed)
{
    Random random(seed);
    std::vector<glm::vec4> out;
    const auto next = [&] { return float(1000.0 * random.uniform()); };
    for (u32 i = 0; i < count; ++i) {
        const float r = next(), g = next(), b = next();
        out.emplace_back(r, g, b, next());
    }
    return out;
}

std::vector<glm::dvec4> toDouble(const std::vector<glm::vec4>& v)
{
    return {v.begin(), v.end()};
}

class GatherTest : public GpuTest
{
protected:
    void execute(FrameGraph& graph)
    {
        const Status compiled = graph.compile(context());
        ASSERT_TRUE(compiled.ok()) << compiled.error().message;
        Recorder recorder(context());
        recorder.begin();
        graph.execute(recorder);
        recorder.submitAndWait();
    }

    TileTables upload(const TileView& view, bool texels)
    {
        auto tile = uploadTile(context(), view);
        EXPECT_TRUE(tile.ok()) << tile.error().message;
        EXPECT_TRUE(tile->texelLinks) << "the test device reads texel buffers";
        tile->texelLinks = texels;
        return std::move(*tile);
    }

    std::vector<glm::vec4> gather(const TileTables& tile, const std::vector<glm::vec4>& radiosity)
    {
        const Buffer from = makeBuffer(context(), "B", radiosity);
        const Buffer to = makeBuffer(context(), "E", std::vector<glm::vec4>(tile.nodeCount, glm::vec4(-1.0f)));
        FrameGraph graph("gather");
        (void)addGather(graph, tile, graph.import(from), graph.import(to));
        execute(graph);
        return downloadItems<glm::vec4>(context(), to);
    }

    /// |device - twin| <= (row length + 2) 2^-24 sum |F B|, the bound of a sequential sum of rounded products.
    void expectWithinBound(const TileView& view, const std::vector<glm::vec4>& radiosity)
    {
        const std::vector<twin::RowSum> expected = twin::gather(view, radiosity);
        std::vector<std::vector<glm::vec4>> results;
        for (const bool texels : {true, false}) {
            const TileTables tile = upload(view, texels);
            results.push_back(gather(tile, radiosity));
            for (size_t i = 0; i < expected.size(); ++i) {
                const double length = view.linkRows[i + 1] - view.linkRows[i];
                for (int c = 0; c < 4; ++c)
                    EXPECT_LE(std::abs(double(results.back()[i][c]) - expected[i].sum[c]),
                              (length + 2.0) * kUnit * expected[i].absolute[c])
                        << "row " << i << ", channel " << c << (texels ? ", texels" : ", storage");
            }
        }
        EXPECT_EQ(results[0], results[1]) << "texel and storage variants differ";
    }
};

TEST(StageTwins, GathersPullsAndPushesByHand)
{
    TileBuilder b;
    b.patch({0, 0, 1}, 1.0f, kGrey);
    b.patch({0, 0, 1}, 3.0f, kGrey);
    const u32 root = b.group({0, 1});
    b.link(0, 1, 0.5f);
    b.link(0, root, 0.25f);
    const TileView view = b.view();
    EXPECT_EQ(twin::gather(view, std::vector<glm::vec4>{glm::vec4(1), glm::vec4(2), glm::vec4(8)})[0].sum,
              glm::dvec4(3.0));
    EXPECT_EQ(twin::pullUp(view, std::vector<glm::dvec4>{glm::dvec4(1), glm::dvec4(5)})[root], glm::dvec4(4.0));
    EXPECT_EQ(twin::pushDown(view, std::vector<glm::dvec4>{glm::dvec4(1), glm::dvec4(2), glm::dvec4(10)})[1],
              glm::dvec4(12.0));
}

TEST_F(GatherTest, RowsOfAnyLength)
{
    TileBuilder b = makeTree(1000, 1);
    Random random(2);
    const u32 nodes = u32(b.patches.size() + b.groups.size());
    // Row 0 stays empty, row 1 has one link, row 2 a hundred thousand; the others a few, inner nodes too.
    b.link(1, 7, 0.3f);
    for (u32 k = 0; k < 100000; ++k) b.link(2, u32(random.uniform() * nodes), float(random.uniform() * 1e-4));
    for (u32 i = 3; i < nodes; ++i)
        for (u32 k = 0; k < i % 37; ++k) b.link(i, u32(random.uniform() * nodes), float(random.uniform()));
    expectWithinBound(b.view(), randomLight(nodes, 3));
}

TEST_F(GatherTest, EmptyRowIsDarkAndLinkOfOneRowIsExact)
{
    TileBuilder b;
    b.patch({0, 0, 1}, 1.0f, kGrey);
    b.patch({0, 0, 1}, 1.0f, kGrey);
    b.link(1, 0, 0.3f);
    const std::vector<glm::vec4> e = gather(upload(b.view(), true), {glm::vec4(3, 5, 7, 11), glm::vec4(1e30f)});
    EXPECT_EQ(e[0], glm::vec4(0.0f));
    EXPECT_EQ(e[1], 0.3f * glm::vec4(3, 5, 7, 11));
}

TEST_F(GatherTest, PagesOfLinks)
{
    TileBuilder b = makeTree(300, 4);
    Random random(5);
    const u32 nodes = u32(b.patches.size() + b.groups.size());
    for (u32 i = 0; i < nodes; ++i)
        for (u32 k = 0; k < i % 11; ++k) b.link(i, u32(random.uniform() * nodes), float(random.uniform()));
    const TileView view = b.view();
    const std::vector<glm::vec4> light = randomLight(nodes, 6);
    TileTables tile = upload(view, true);
    const std::vector<glm::vec4> whole = gather(tile, light);

    const auto packed = packLinks(view.linkRows, view.linkColumns, view.linkFactors, 64);
    ASSERT_TRUE(packed.ok());
    ASSERT_GT(packed->pages.size(), 5u);
    tile.links.clear();
    for (const LinkPage& page : packed->pages)
        tile.links.push_back(
            {page,
             makeBuffer(context(), "page",
                        std::span<const gpu::LinkPairRecord>(packed->pairs).subspan(page.pairFirst, page.pairCount))});
    EXPECT_EQ(gather(tile, light), whole);
}

TEST_F(GatherTest, PullsMeansUpAndPushesSumsDown)
{
    TileBuilder b = makeTree(2000, 7);
    const TileView view = b.view();
    const TileTables tile = upload(view, true);
    const std::vector<glm::vec4> light = randomLight(tile.nodeCount, 8);
    const Buffer up = makeBuffer(context(), "up", light), down = makeBuffer(context(), "down", light);
    FrameGraph graph("push and pull");
    (void)addPull(graph, tile, graph.import(up));
    (void)addPush(graph, tile, graph.import(down));
    execute(graph);
    const auto pulled = downloadItems<glm::vec4>(context(), up), pushed = downloadItems<glm::vec4>(context(), down);
    const auto means = twin::pullUp(view, toDouble({light.begin(), light.begin() + tile.patchCount}));
    const auto sums = twin::pushDown(view, toDouble(light));
    ASSERT_GT(tile.levels.size(), 3u);
    for (u32 i = 0; i < tile.nodeCount; ++i) {
        // Five positive terms and a rounded weight a level: 7 roundings a level, 5 levels.
        EXPECT_LE(std::abs(double(pulled[i].x) - means[i].x), 35.0 * kUnit * means[i].x) << i;
        EXPECT_LE(std::abs(double(pushed[i].w) - sums[i].w), 6.0 * kUnit * sums[i].w) << i;
    }
}

class SweepTest : public GatherTest
{
protected:
    struct Result
    {
        std::vector<glm::vec4> irradiance, radiosity;
        gpu::ResidualRecord sums{};
    };

    Result sweep(const TileView& view, const std::vector<glm::vec4>& sun, const std::vector<glm::vec4>& sky, u32 sweeps)
    {
        const TileTables tile = upload(view, true);
        const std::vector<glm::vec4> zeros(tile.nodeCount, glm::vec4(0.0f));
        const Buffer eSun = makeBuffer(context(), "sun", sun), eSky = makeBuffer(context(), "sky", sky);
        const Buffer b0 = makeBuffer(context(), "B0", zeros), radiosity = makeBuffer(context(), "B", zeros);
        const Buffer irradiance = makeBuffer(context(), "E", zeros);
        const Buffer partials = makeBuffer(context(), "partials", std::vector<gpu::ResidualRecord>(updateGroups(tile)));
        const Buffer residual = makeBuffer(context(), "residual", std::vector<gpu::ResidualRecord>(1));
        FrameGraph graph("sweeps");
        LightRefs light =
            addFirstLight(graph, tile, {graph.import(eSun), graph.import(eSky)},
                          {graph.import(b0), graph.import(radiosity), graph.import(irradiance)}, true, false);
        UpdateRefs out{light, graph.import(residual)};
        for (u32 k = 0; k < sweeps; ++k) out = addSweep(graph, tile, out.light, graph.import(partials), out.residual);
        execute(graph);
        Result result{
            downloadItems<glm::vec4>(context(), irradiance), downloadItems<glm::vec4>(context(), radiosity), {}};
        result.irradiance.resize(tile.patchCount);
        result.radiosity.resize(tile.patchCount);
        result.sums = downloadItems<gpu::ResidualRecord>(context(), residual)[0];
        return result;
    }
};

/// Random links whose rows sum to at most one, on every node of a tree.
TileBuilder makeLinked(u32 patchCount)
{
    TileBuilder b = makeTree(patchCount, 9);
    Random random(10);
    const u32 nodes = u32(b.patches.size() + b.groups.size());
    for (u32 i = 0; i < nodes; ++i)
        for (u32 k = 0; k < 12; ++k) b.link(i, u32(random.uniform() * nodes), float(random.uniform() / 60.0));
    return b;
}

TEST_F(SweepTest, AgreesWithTheTwin)
{
    TileBuilder b = makeLinked(3000);
    const TileView view = b.view();
    const auto sun = randomLight(3000, 11), sky = randomLight(3000, 12);
    std::vector<glm::dvec4> b0;
    for (u32 i = 0; i < 3000; ++i)
        b0.push_back(glm::dvec4(view.patches[i].emission) +
                     glm::dvec4(view.patches[i].rho) * (glm::dvec4(sun[i]) + glm::dvec4(sky[i])));
    for (const u32 sweeps : {1u, 4u}) {
        const twin::Solution expected = twin::solve(view, b0, sweeps);
        const Result result = sweep(view, sun, sky, sweeps);
        for (u32 i = 0; i < 3000; ++i)
            for (int c = 0; c < 4; ++c) {
                // All terms are positive, so errors stay relative: about 60 roundings a sweep.
                EXPECT_NEAR(result.irradiance[i][c], expected.indirect[i][c],
                            sweeps * 60 * kUnit * expected.indirect[i][c]);
                EXPECT_NEAR(result.radiosity[i][c], expected.radiosity[i][c],
                            sweeps * 60 * kUnit * expected.radiosity[i][c]);
            }
        // The change of a late sweep is a small difference of rounded values: 1e-4 of it is far from a wrong norm.
        EXPECT_NEAR(residualOf(result.sums), expected.residual, 1e-4 * expected.residual);
        double mean = 0.0;
        for (u32 i = 0; i < 3000; ++i) mean += double(view.patches[i].area) * expected.radiosity[i].w;
        EXPECT_NEAR(double(result.sums.radiosity.w), mean, 1e-5 * mean);
    }
}

TEST(Residual, LightBeyondAFloatNeverCountsAsConverged)
{
    gpu::ResidualRecord sums{};
    sums.change = glm::vec4(std::numeric_limits<float>::quiet_NaN(), 0.0f, 0.0f, 0.0f);
    sums.scale = glm::vec4(1.0f);
    EXPECT_FALSE(residualOf(sums) <= 1.0);
    EXPECT_FALSE(remainingErrorOf(sums, sums) <= 1.0);
    sums.change = sums.scale = glm::vec4(std::numeric_limits<float>::infinity());
    EXPECT_FALSE(residualOf(sums) <= 1.0);
}

TEST_F(SweepTest, SameBytesTwice)
{
    TileBuilder b = makeLinked(5000);
    const auto sun = randomLight(5000, 13), sky = randomLight(5000, 14);
    const Result first = sweep(b.view(), sun, sky, 3), second = sweep(b.view(), sun, sky, 3);
    EXPECT_EQ(std::memcmp(first.irradiance.data(), second.irradiance.data(), first.irradiance.size() * 16), 0);
    EXPECT_EQ(std::memcmp(first.radiosity.data(), second.radiosity.data(), first.radiosity.size() * 16), 0);
    EXPECT_EQ(std::memcmp(&first.sums, &second.sums, sizeof(first.sums)), 0);
}

TEST_F(SweepTest, WithoutLinksOneSweepIsTheAnswer)
{
    TileBuilder b = makeTree(10, 15);
    const auto sun = randomLight(10, 16);
    const Result result = sweep(b.view(), sun, sun, 1);
    EXPECT_EQ(residualOf(result.sums), 0.0);
    for (const glm::vec4& e : result.irradiance) EXPECT_EQ(e, glm::vec4(0.0f));
}

} // namespace

} // namespace helio
