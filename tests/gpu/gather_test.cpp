// SPDX-License-Identifier: Apache-2.0
// Stage 3 against the double-precision twin, within the bound of a sequential float sum; and its parts.
#include "engine/stages/gather.h"

#include <array>
#include <bit>
#include <cmath>
#include <glm/common.hpp>
#include <glm/packing.hpp>

#include "city/base/hash.h"
#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/stages/acceleration.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage_twins.h"
#include "tests/support/tile_builder.h"
#include "tests/support/unpack_links.h"

namespace helio {

namespace {

constexpr double kUnit = 0x1.0p-24; // rounding of one float operation, relative
constexpr double kHalf = 0x1.0p-12; // of a half float

const glm::vec4 kGrey(0.5f, 0.25f, 0.125f, 0.75f);

/// What children add to slopes, of either sign: those of no geometry, but nothing in the pull relies on that. Slopes of
/// values up to 1 stay below the number of levels.
std::vector<gpu::ChildSlopeRecord> randomSlopes(Random& random, size_t count)
{
    std::vector<gpu::ChildSlopeRecord> slopes(count);
    for (gpu::ChildSlopeRecord& s : slopes) {
        for (float* value : {&s.offsetX, &s.offsetY}) *value = float(2.0 * random.uniform() - 1.0);
        for (float* value : {&s.xx, &s.xy, &s.yx, &s.yy}) *value = float(random.uniform() - 0.5);
    }
    return slopes;
}

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
        for (size_t i = 0; i < level.size(); i += 5) {
            const size_t end = std::min(i + 5, level.size());
            next.push_back(
                b.group({level.begin() + long(i), level.begin() + long(end)}, randomSlopes(random, end - i)));
        }
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

/// Senders as the device keeps them: means of all nodes and, of inner nodes, slopes over the means in half floats.
struct DeviceLight
{
    std::vector<glm::vec4> mean, overX, overY;
};

glm::vec4 toHalves(const glm::vec4& v)
{
    const glm::vec2 rg = glm::unpackHalf2x16(glm::packHalf2x16({v.r, v.g}));
    const glm::vec2 ba = glm::unpackHalf2x16(glm::packHalf2x16({v.b, v.a}));
    return {rg.x, rg.y, ba.x, ba.y};
}

/// Random light; slopes of either sign, as large as the means.
DeviceLight randomNodeLight(const TileView& view, u64 seed)
{
    DeviceLight light{randomLight(u32(view.nodes.size()), seed), {}, {}};
    if (view.linkMoments.empty()) return light;
    const u32 inner = u32(view.nodes.size() - view.patches.size());
    for (std::vector<glm::vec4>* over : {&light.overX, &light.overY})
        for (const glm::vec4& v : randomLight(inner, ++seed)) over->push_back(toHalves(v / 500.0f - 1.0f));
    return light;
}

std::vector<glm::vec4> sendersOf(const DeviceLight& light)
{
    const size_t patches = light.mean.size() - light.overX.size();
    std::vector<glm::vec4> senders(light.mean.begin(), light.mean.begin() + long(patches));
    for (size_t k = 0; k < light.overX.size(); ++k) {
        const glm::vec4 x = light.overX[k], y = light.overY[k];
        senders.push_back(light.mean[patches + k]);
        senders.push_back(
            std::bit_cast<glm::vec4>(glm::uvec4(glm::packHalf2x16({x.r, x.g}), glm::packHalf2x16({x.b, x.a}),
                                                glm::packHalf2x16({y.r, y.g}), glm::packHalf2x16({y.b, y.a}))));
    }
    return senders;
}

twin::NodeLight toTwin(const DeviceLight& light)
{
    twin::NodeLight out{toDouble(light.mean), std::vector<glm::dvec4>(light.mean.size(), glm::dvec4(0.0)), {}};
    out.slopeY = out.slopeX;
    const size_t patches = light.mean.size() - light.overX.size();
    for (size_t k = 0; k < light.overX.size(); ++k) {
        out.slopeX[patches + k] = out.mean[patches + k] * glm::dvec4(light.overX[k]);
        out.slopeY[patches + k] = out.mean[patches + k] * glm::dvec4(light.overY[k]);
    }
    return out;
}

/// The tile with the links that the short form makes of its own; keeps the arrays.
struct RoundedTile
{
    explicit RoundedTile(const TileView& tile) : view(tile)
    {
        const u32 patches = u32(tile.patches.size()), nodes = u32(tile.nodes.size());
        const RowLevel all{0, nodes};
        const auto packed =
            packLinks({tile.linkRows, tile.linkColumns, tile.linkFactors, tile.linkMoments, patches}, {&all, 1}, {});
        EXPECT_TRUE(packed.ok());
        rows.push_back(0);
        for (const auto& row : twin::unpackLinks(*packed, nodes, patches)) {
            for (const twin::UnpackedLink& link : row) {
                columns.push_back(link.column);
                factors.push_back(float(link.factor));
                if (tile.linkMoments.empty()) continue;
                moments.push_back(float(link.momentX));
                moments.push_back(float(link.momentY));
            }
            rows.push_back(u32(columns.size()));
        }
        view.linkRows = rows;
        view.linkColumns = columns;
        view.linkFactors = factors;
        view.linkMoments = moments;
    }

    std::vector<u32> rows, columns;
    std::vector<float> factors, moments;
    TileView view;
};

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

    TileTables upload(const TileView& view, const UploadOptions& options = {.exactLinks = true})
    {
        auto tile = uploadTile(context(), view, options);
        EXPECT_TRUE(tile.ok()) << tile.error().message;
        return std::move(*tile);
    }

    /// The ways of reading that this device has for arrays of so many elements.
    std::vector<Reads> allReads(u64 elements)
    {
        std::vector<Reads> all;
        for (const Reads reads : {Reads::Storage, Reads::Texels, Reads::Images})
            if (canRead(context(), reads, elements)) all.push_back(reads);
        return all;
    }

    std::vector<glm::vec4> gather(const TileTables& tile, const DeviceLight& light)
    {
        const Buffer from = makeBuffer(context(), "B", sendersOf(light));
        const Buffer to = makeBuffer(context(), "E", std::vector<glm::vec4>(tile.nodeCount, glm::vec4(-1.0f)));
        FrameGraph graph("gather");
        (void)addGather(graph, tile, {{}, graph.import(from), graph.import(to)});
        execute(graph);
        return downloadItems<glm::vec4>(context(), to);
    }

    /// |device - twin| <= (terms + 12) 2^-24 sum |term|, the bound of a sequential sum of rounded products; a link has
    /// one term, F B, or three, with its moments. What comes down from the ancestors has errors of its own.
    void expectWithinBound(const TileView& view, const DeviceLight& light)
    {
        std::vector<std::vector<glm::vec4>> results;
        const RoundedTile rounded(view);
        u64 longest = view.nodes.size();
        for (size_t i = 0; i < view.nodes.size(); ++i)
            longest = std::max<u64>(longest, view.linkRows[i + 1] - view.linkRows[i]);
        for (const bool exact : {true, false}) {
            const TileView& seen = exact ? view : rounded.view;
            const std::vector<twin::RowSum> own = twin::gather(seen, toTwin(light));
            const double terms = view.linkMoments.empty() ? 1.0 : 3.0;
            std::vector<glm::dvec4> sums, bounds;
            for (size_t i = 0; i < own.size(); ++i) {
                sums.push_back(own[i].sum);
                const double length = terms * double(seen.linkRows[i + 1] - seen.linkRows[i]);
                bounds.push_back((length + 12.0) * kUnit * own[i].absolute);
            }
            const std::vector<glm::dvec4> expected = twin::pushDown(view, sums), bound = twin::pushDown(view, bounds);
            const size_t first = results.size();
            for (const Reads reads : allReads(gpu::kStripRows * longest)) {
                const TileTables tile = upload(view, {exact, reads});
                results.push_back(gather(tile, light));
                for (size_t i = 0; i < expected.size(); ++i)
                    for (int c = 0; c < 4; ++c)
                        EXPECT_LE(std::abs(double(results.back()[i][c]) - expected[i][c]), bound[i][c])
                            << "row " << i << ", channel " << c << ", reads " << int(reads)
                            << (exact ? ", exact" : ", short");
                EXPECT_EQ(results.back(), results[first]) << "variants differ";
            }
        }
        EXPECT_NE(results[0], results.back()) << "the short form rounds";
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
    EXPECT_EQ(twin::gather(view, {{glm::dvec4(1), glm::dvec4(2), glm::dvec4(8)}, {}, {}})[0].sum, glm::dvec4(3.0));
    EXPECT_EQ(twin::pullUp(view, std::vector<glm::dvec4>{glm::dvec4(1), glm::dvec4(5)})[root], glm::dvec4(4.0));
    EXPECT_EQ(twin::pushDown(view, std::vector<glm::dvec4>{glm::dvec4(1), glm::dvec4(2), glm::dvec4(10)})[1],
              glm::dvec4(12.0));
}

TEST(StageTwins, SlopesByHand)
{
    // Three patches of 1 m2 at x = 0, 1 and 3; the first two are a pair. Pair: centroid 0.5, deviation 0.5; root:
    // centroid 4/3, deviation sqrt(14)/3. The coordinate of a point in either: (x - centroid) / deviation.
    TileBuilder b;
    b.linear = true;
    for (int i = 0; i < 3; ++i) b.patch({0, 0, 1}, 1.0f, kGrey);
    const float s = std::sqrt(14.0f) / 3.0f, third = 1.0f / 3.0f;
    const auto child = [](float offset, float scale) { return gpu::ChildSlopeRecord{offset, 0, scale, 0, 0, 0}; };
    const u32 pair = b.group({0, 1}, {child(-1, 0), child(1, 0)});
    const u32 root = b.group({pair, 2}, {child((0.5f - 4 * third) / s, 0.5f / s), child((3 - 4 * third) / s, 0)});
    b.link(2, pair, 0.5f, {0.25f, 100.0f});
    b.link(2, root, 0.0f, {1.0f, 0.0f});
    const TileView view = b.view();
    // B = 6 + 2 x is 6 and 8 on the pair: mean 7, slope 1; on the root 26/3, slope 2 sqrt(14)/3.
    const twin::NodeLight light =
        twin::pullLight(view, std::vector<glm::dvec4>{glm::dvec4(6), glm::dvec4(8), glm::dvec4(12)});
    EXPECT_NEAR(light.mean[pair].x, 7.0, 1e-12);
    EXPECT_NEAR(light.slopeX[pair].x, 1.0, 1e-6);
    EXPECT_NEAR(light.mean[root].x, 26.0 / 3.0, 1e-6);
    EXPECT_NEAR(light.slopeX[root].x, 2.0 * std::sqrt(14.0) / 3.0, 1e-6);
    EXPECT_EQ(light.slopeY[root], glm::dvec4(0.0));
    EXPECT_NEAR(twin::gather(view, light)[2].sum.x, 0.5 * 7 + 0.25 + 2.0 * std::sqrt(14.0) / 3.0, 1e-5);
}

/// Links of either kind; only those to inner nodes should take notice of the moments.
void addLink(TileBuilder& b, Random& random, u32 receiver, u32 sender, double largest)
{
    const auto signedUpTo = [&](double limit) { return float(limit * (2.0 * random.uniform() - 1.0)); };
    const float x = signedUpTo(largest), y = signedUpTo(largest);
    b.link(receiver, sender, float(random.uniform() * largest), {x, y});
}

TEST_F(GatherTest, RowsOfAnyLength)
{
    for (const bool linear : {false, true}) {
        TileBuilder b = makeTree(1000, 1);
        b.linear = linear;
        Random random(2);
        const u32 nodes = u32(b.patches.size() + b.groups.size());
        const auto anyNode = [&] { return u32(random.uniform() * nodes); };
        // Row 0 stays empty, row 1 has one link, row 2 sixty thousand, rows 3 and 4 one kind of sender alone; the
        // others a few, inner nodes too.
        b.link(1, 7, 0.3f);
        for (u32 k = 0; k < 60000; ++k) addLink(b, random, 2, anyNode(), 1e-4);
        for (u32 k = 0; k < 7; ++k) addLink(b, random, 3, 100 + k, 1.0);
        for (u32 k = 0; k < 7; ++k) addLink(b, random, 4, 1000 + k, 1.0);
        for (u32 i = 5; i < nodes; ++i)
            for (u32 k = 0; k < i % 37; ++k) addLink(b, random, i, anyNode(), 1.0);
        expectWithinBound(b.view(), randomNodeLight(b.view(), 3));
    }
}

TEST_F(GatherTest, EmptyRowIsDarkAndLinkOfOneRowIsExact)
{
    for (const bool linear : {false, true}) {
        TileBuilder b;
        b.linear = linear;
        for (int i = 0; i < 3; ++i) b.patch({0, 0, 1}, 1.0f, kGrey);
        const u32 root = b.group({0, 1});
        b.link(1, 0, 0.3f, {7.0f, 7.0f}); // a patch has no slope
        b.link(2, root, 0.25f, {0.5f, -2.0f});
        DeviceLight light{{glm::vec4(3, 5, 7, 11), glm::vec4(1e30f), glm::vec4(1e30f), glm::vec4(1, 2, 3, 4)}, {}, {}};
        if (linear) light.overX = {glm::vec4(2)}, light.overY = {glm::vec4(1, 0, -1, 0.5f)};
        const std::vector<glm::vec4> e = gather(upload(b.view()), light);
        EXPECT_EQ(e[0], glm::vec4(0.0f));
        EXPECT_EQ(e[1], 0.3f * glm::vec4(3, 5, 7, 11));
        const glm::vec4 mean = 0.25f * glm::vec4(1, 2, 3, 4), slopes = glm::vec4(1, 2, 3, 4) - glm::vec4(2, 0, -6, 4);
        EXPECT_EQ(e[2], linear ? mean + slopes : mean);
    }
}

TEST_F(GatherTest, ShortLinksGiveTheBitsOfTheSameLinksInFullPrecision)
{
    // Factors on the grid of the short form, and moments of 0 or the limit: the sums have the same terms in the same
    // order.
    TileBuilder b = makeTree(500, 31);
    b.linear = true;
    Random random(32);
    const u32 nodes = u32(b.patches.size() + b.groups.size());
    for (u32 i = 0; i < nodes; ++i)
        for (u32 k = 0; k < i % 9; ++k) {
            const float factor = float(decodeFactor(u32(random.uniform() * 3900.0), 12));
            const float limit = gpu::kMomentLimit * factor;
            b.link(i, u32(random.uniform() * 500), factor, {k % 2 ? limit : 0.0f, k % 3 ? -limit : 0.0f});
        }
    const DeviceLight light = randomNodeLight(b.view(), 33);
    const std::vector<glm::vec4> exact = gather(upload(b.view()), light);
    for (const Reads reads : allReads(1u << 16)) {
        const TileTables tile = upload(b.view(), {false, reads});
        EXPECT_EQ(tile.links.singles, 0u);
        EXPECT_EQ(gather(tile, light), exact);
    }
}

TEST_F(GatherTest, PagesOfLinks)
{
    for (const bool linear : {false, true}) {
        TileBuilder b = makeTree(300, 4);
        b.linear = linear;
        Random random(5);
        const u32 nodes = u32(b.patches.size() + b.groups.size());
        for (u32 i = 0; i < nodes; ++i)
            for (u32 k = 0; k < i % 11; ++k) addLink(b, random, i, u32(random.uniform() * nodes), 1.0);
        const TileView view = b.view();
        const DeviceLight light = randomNodeLight(view, 6);
        for (const bool exact : {false, true}) {
            const std::vector<glm::vec4> whole = gather(upload(view, {.exactLinks = exact}), light);
            for (const Reads reads : allReads(1u << 16)) {
                const TileTables tile = upload(view, {exact, reads, 128});
                EXPECT_GT(tile.links.pages.size(), 3u);
                EXPECT_EQ(gather(tile, light), whole);
            }
        }
    }
}

TEST_F(GatherTest, PullsSlopesUp)
{
    constexpr u32 kPatches = 2000;
    TileBuilder b = makeTree(kPatches, 7);
    b.linear = true;
    b.link(0, kPatches, 0.5f, {0.25f, 0.0f}); // senders are linear where links have moments
    const TileView view = b.view();
    for (const Reads reads : allReads(1u << 16)) {
        const TileTables tile = upload(view, {true, reads});
        ASSERT_TRUE(tile.linear);
        std::vector<glm::vec4> light = randomLight(kPatches, 8);
        const twin::NodeLight expected = twin::pullLight(view, toDouble(light));
        light.resize(tile.senderCount());
        const Buffer senders = makeBuffer(context(), "B", light);
        FrameGraph graph("pull");
        (void)addPullSenders(graph, tile, graph.import(senders));
        execute(graph);
        const auto pulled = downloadItems<glm::vec4>(context(), senders);
        ASSERT_EQ(tile.levels.size(), 5u);
        // On level k slopes stay below 1000 k, and half floats round them by 2^-11 k of what they are; a level takes
        // over the errors of the one below: 1000 (1 + 2 + 3 + 4 + 5) 2^-11 over five levels.
        constexpr double kSlopeTolerance = 15.0 * 1000.0 / 2048.0;
        double apart = 0.0;
        for (u32 i = kPatches; i < tile.nodeCount; ++i) {
            const size_t at = kPatches + 2 * (i - kPatches);
            EXPECT_LE(std::abs(double(pulled[at].x) - expected.mean[i].x), 35.0 * kUnit * expected.mean[i].x) << i;
            const auto words = std::bit_cast<glm::uvec4>(pulled[at + 1]);
            const glm::vec2 xs[] = {glm::unpackHalf2x16(words.x), glm::unpackHalf2x16(words.y)};
            const glm::vec2 ys[] = {glm::unpackHalf2x16(words.z), glm::unpackHalf2x16(words.w)};
            for (int c = 0; c < 4; ++c) {
                const double mean = double(pulled[at][c]);
                EXPECT_NEAR(mean * double(xs[c / 2][c % 2]), expected.slopeX[i][c], kSlopeTolerance) << i;
                EXPECT_NEAR(mean * double(ys[c / 2][c % 2]), expected.slopeY[i][c], kSlopeTolerance) << i;
                apart = std::max(apart, std::abs(expected.slopeX[i][c]));
            }
        }
        EXPECT_GT(apart, 50.0 * kSlopeTolerance) << "slopes are much larger than what they may err by";
    }
}

TEST_F(GatherTest, DarknessHasNoSlopes)
{
    TileBuilder b = makeTree(10, 7);
    b.linear = true;
    b.link(0, 10, 0.5f, {0.25f, 0.0f});
    const TileTables tile = upload(b.view());
    const Buffer senders = makeBuffer(context(), "B", std::vector<glm::vec4>(tile.senderCount(), glm::vec4(0.0f)));
    FrameGraph graph("pull");
    (void)addPullSenders(graph, tile, graph.import(senders));
    execute(graph);
    for (const glm::vec4& v : downloadItems<glm::vec4>(context(), senders)) EXPECT_EQ(v, glm::vec4(0.0f));
}

TEST_F(GatherTest, PullsMeansUp)
{
    TileBuilder b = makeTree(2000, 7);
    const TileView view = b.view();
    const TileTables tile = upload(view);
    const std::vector<glm::vec4> light = randomLight(tile.nodeCount, 8);
    const Buffer up = makeBuffer(context(), "up", light);
    FrameGraph graph("pull");
    (void)addPull(graph, tile, graph.import(up));
    execute(graph);
    const auto pulled = downloadItems<glm::vec4>(context(), up);
    const auto means = twin::pullUp(view, toDouble({light.begin(), light.begin() + tile.patchCount}));
    ASSERT_GT(tile.levels.size(), 3u);
    // Five positive terms and a rounded weight a level: 7 roundings a level, 5 levels.
    for (u32 i = 0; i < tile.nodeCount; ++i)
        EXPECT_LE(std::abs(double(pulled[i].x) - means[i].x), 35.0 * kUnit * means[i].x) << i;
}

class SweepTest : public GatherTest
{
protected:
    struct Result
    {
        std::vector<glm::vec4> irradiance, radiosity;
        gpu::ResidualRecord sums{};
    };

    Result sweep(const TileView& view, const std::vector<glm::vec4>& sun, const std::vector<glm::vec4>& sky, u32 sweeps,
                 const glm::dvec4& radius = glm::dvec4(0.0), const UploadOptions& options = {.exactLinks = true})
    {
        const TileTables tile = upload(view, options);
        const std::vector<glm::vec4> zeros(tile.nodeCount, glm::vec4(0.0f));
        const Buffer eSun = makeBuffer(context(), "sun", sun), eSky = makeBuffer(context(), "sky", sky);
        const Buffer b0 = makeBuffer(context(), "B0", zeros), irradiance = makeBuffer(context(), "E", zeros);
        // What lies in the second array at first is nobody's light and must not matter.
        const Buffer one = makeBuffer(context(), "B", std::vector<glm::vec4>(tile.senderCount()));
        const Buffer two =
            makeBuffer(context(), "B, other",
                       std::vector<glm::vec4>(tile.senderCount(), glm::vec4(std::numeric_limits<float>::quiet_NaN())));
        const Buffer parts = makeBuffer(context(), "parts", std::vector<gpu::ResidualRecord>(residualParts(tile)));
        const Buffer residual = makeBuffer(context(), "residual", std::vector<gpu::ResidualRecord>(1));
        FrameGraph graph("sweeps");
        const LightRefs light =
            addFirstLight(graph, tile, {graph.import(eSun), graph.import(eSky)},
                          {graph.import(b0), graph.import(one), graph.import(irradiance)}, true, false);
        SweepResult out{light, {graph.import(two), graph.import(parts), graph.import(residual)}};
        glm::dvec4 weight(1.0);
        for (u32 k = 0; k < sweeps; ++k) {
            weight = chebyshevWeight(k, weight, radius);
            out = addSweep(graph, tile, out.light, out.spent, glm::vec4(weight));
        }
        execute(graph);
        Result result{downloadItems<glm::vec4>(context(), irradiance),
                      downloadItems<glm::vec4>(context(), sweeps % 2 ? two : one),
                      {}};
        result.irradiance.resize(tile.patchCount);
        result.radiosity.resize(tile.patchCount);
        result.sums = downloadItems<gpu::ResidualRecord>(context(), residual)[0];
        return result;
    }
};

/// Random links whose rows sum to at most one, on every node of a tree.
TileBuilder makeLinked(u32 patchCount, bool linear = false)
{
    TileBuilder b = makeTree(patchCount, 9);
    b.linear = linear;
    Random random(10);
    const u32 nodes = u32(b.patches.size() + b.groups.size());
    for (u32 i = 0; i < nodes; ++i)
        for (u32 k = 0; k < 12; ++k) {
            const u32 sender = u32(random.uniform() * nodes);
            const float factor = float(random.uniform() / 60.0);
            b.link(i, sender, factor, factor * glm::vec2(0.5f, -0.25f));
        }
    return b;
}

TEST_F(SweepTest, AgreesWithTheTwin)
{
    for (const bool linear : {false, true}) {
        TileBuilder b = makeLinked(3000, linear);
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
                    // All terms are positive, so errors stay relative: about 60 roundings a sweep; slopes, here as
                    // large as the means, are half floats.
                    const double tolerance = sweeps * (60 * kUnit + (linear ? kHalf : 0.0));
                    EXPECT_NEAR(result.irradiance[i][c], expected.indirect[i][c], tolerance * expected.indirect[i][c]);
                    EXPECT_NEAR(result.radiosity[i][c], expected.radiosity[i][c], tolerance * expected.radiosity[i][c]);
                }
            // The change of a late sweep is a small difference of rounded values: 1e-4 of it is far from a wrong norm,
            // and so is a hundredth where slopes are rounded.
            EXPECT_NEAR(residualOf(result.sums), expected.residual, (linear ? 1e-2 : 1e-4) * expected.residual);
            for (int c = 0; c < 4; ++c)
                EXPECT_NEAR(double(result.sums.largest[c]), expected.largest[c],
                            (linear ? 1e-2 : 1e-3) * expected.largest[c]);
            double mean = 0.0;
            for (u32 i = 0; i < 3000; ++i) mean += double(view.patches[i].area) * expected.radiosity[i].w;
            EXPECT_NEAR(double(result.sums.radiosity.w), mean, 1e-5 * mean);
        }
    }
}

TEST_F(SweepTest, ChebyshevAgreesWithTheTwin)
{
    // Two channels are accelerated, two are not.
    TileBuilder b = makeLinked(3000, true);
    const TileView view = b.view();
    const auto sun = randomLight(3000, 11), sky = randomLight(3000, 12);
    std::vector<glm::dvec4> b0;
    for (u32 i = 0; i < 3000; ++i)
        b0.push_back(glm::dvec4(view.patches[i].emission) +
                     glm::dvec4(view.patches[i].rho) * (glm::dvec4(sun[i]) + glm::dvec4(sky[i])));
    const glm::dvec4 radius(0.9, 0.0, 0.6, 0.0);
    for (const u32 sweeps : {1u, 2u, 5u}) {
        const twin::Solution expected = twin::solve(view, b0, sweeps, radius), plain = twin::solve(view, b0, sweeps);
        const Result result = sweep(view, sun, sky, sweeps, radius);
        double apart = 0.0;
        for (u32 i = 0; i < 3000; ++i)
            for (int c = 0; c < 4; ++c) {
                // The weights are below 2: the terms are not all positive, but their sizes add up to three times B.
                EXPECT_NEAR(result.radiosity[i][c], expected.radiosity[i][c],
                            3.0 * sweeps * (60 * kUnit + kHalf) * expected.radiosity[i][c]);
                apart = std::max(apart, std::abs(plain.radiosity[i][c] - expected.radiosity[i][c]));
            }
        EXPECT_EQ(apart > 1.0, sweeps > 1) << "the first sweep is plain, the others are not";
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
    TileBuilder b = makeLinked(5000, true);
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
