// SPDX-License-Identifier: Apache-2.0
// Three solvers of the same links on the same tree must agree: the engine's sweeps, their plain twin, and the baker's
// reference solver; and all of them with elimination on the matrix that the links stand for.
#include <gtest/gtest.h>

#include "city/base/hash.h"
#include "city/light/linear_senders.h"
#include "city/light/reference_solver.h"
#include "engine/gpu/transfer.h"
#include "engine/stages/gather.h"
#include "tests/numeric/fixtures.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/stage_twins.h"

namespace helio {
namespace {

using test::makeTree;

/// A tree with its links in the form of a pack's tile.
struct TileOfTree
{
    TileOfTree(const NodeTree& tree, const LinkTable& links) : children(tree.children), slopes(links.childSlopes)
    {
        for (const Patch& p : tree.patches) {
            gpu::PatchRecord record{};
            record.area = float(p.area);
            record.rho = glm::vec4(p.rho);
            record.emission = glm::vec4(p.emission);
            patches.push_back(record);
        }
        for (const Node& n : tree.nodes) nodes.push_back({n.parent, n.childBegin, n.childCount, float(n.area)});
        for (const glm::vec2& m : links.moment) moments.insert(moments.end(), {m.x, m.y});
        skyRows.assign(patches.size() + 1, 0);
        view.patches = patches;
        view.nodes = nodes;
        view.children = children;
        view.linkRows = links.rowBegin;
        view.linkColumns = links.column;
        view.linkFactors = links.factor;
        view.linkMoments = moments;
        view.childSlopes = slopes;
        view.skyRows = skyRows;
    }

    std::vector<gpu::PatchRecord> patches;
    std::vector<gpu::NodeRecord> nodes;
    std::vector<u32> children, skyRows;
    std::vector<float> moments;
    std::vector<gpu::ChildSlopeRecord> slopes;
    TileView view;
};

/// A room of 6 x 36 patches of random reflectance and emission, floats all. Every level of its hierarchy is linked with
/// every other at random; row sums stay below 1 with the moments.
struct Room
{
    NodeTree tree = makeTree(test::room({4, 5, 3}, 6, glm::dvec4(0.5), glm::dvec4(0.0)));
    LinkTable links;
    std::vector<double> rho, b0; // channel r

    explicit Room(bool linear)
    {
        Random random(4);
        for (Patch& patch : tree.patches) {
            for (int c = 0; c < 4; ++c) {
                patch.rho[c] = double(float(random.uniform()));
                patch.emission[c] = double(float(10.0 * random.uniform()));
            }
            rho.push_back(patch.rho.x);
            b0.push_back(patch.emission.x);
        }
        std::vector<test::TestLink> list;
        for (u32 i = 0; i < tree.nodeCount(); ++i)
            for (u32 j = 0; j < tree.nodeCount(); ++j)
                if (tree.nodes[i].kind != NodeKind::Cluster && tree.nodes[j].kind != NodeKind::Cluster &&
                    random.uniform() < 0.1)
                    list.push_back({i, j, 0.006 * random.uniform()});
        links = test::makeLinks(tree, list);
        if (!linear) return;
        for (const float factor : links.factor) {
            const float x = float(random.uniform() - 0.5), y = float(random.uniform() - 0.5);
            links.moment.push_back(factor * glm::vec2(x, y));
        }
        links.childSlopes = childSlopes(tree, slopeFrames(tree));
    }
};

class SolverAgreement : public GpuTest
{
protected:
    /// E_indirect and B of the patches after a number of the engine's sweeps.
    std::pair<std::vector<glm::vec4>, std::vector<glm::vec4>> sweep(const TileView& view, u32 sweeps)
    {
        auto tile = uploadTile(context(), view, {.exactLinks = true});
        EXPECT_TRUE(tile.ok()) << tile.error().message;
        const auto zeros = [&](const char* name, size_t count) {
            return makeBuffer(context(), name, std::vector<glm::vec4>(count, glm::vec4(0.0f)));
        };
        const Buffer none = zeros("none", tile->patchCount), b0 = zeros("B0", tile->patchCount),
                     one = zeros("B", tile->senderCount()), two = zeros("B, other", tile->senderCount()),
                     e = zeros("E", tile->nodeCount);
        const Buffer parts = makeBuffer(context(), "parts", std::vector<gpu::ResidualRecord>(residualParts(*tile)));
        const Buffer residual = makeBuffer(context(), "residual", std::vector<gpu::ResidualRecord>(1));
        FrameGraph graph("sweeps");
        const LightRefs start{graph.import(b0), graph.import(one), graph.import(e)};
        SweepResult out{addFirstLight(graph, *tile, {graph.import(none), graph.import(none)}, start, true, false),
                        {graph.import(two), graph.import(parts), graph.import(residual)}};
        for (u32 k = 0; k < sweeps; ++k) out = addSweep(graph, *tile, out.light, out.spent);
        const Status compiled = graph.compile(context());
        EXPECT_TRUE(compiled.ok()) << compiled.error().message;
        Recorder recorder(context());
        recorder.begin();
        graph.execute(recorder);
        recorder.submitAndWait();
        return {downloadItems<glm::vec4>(context(), e), downloadItems<glm::vec4>(context(), sweeps % 2 ? two : one)};
    }
};

TEST_F(SolverAgreement, OnALinkedRoom)
{
    constexpr u32 kSweeps = 40;
    std::vector<double> reds[2];
    for (const bool linear : {false, true}) {
        const Room room(linear);
        const std::vector<glm::dvec4> none(room.tree.patchCount(), glm::dvec4(0.0));
        const Solution reference =
            solveLight(room.tree, room.links, none, none, {.residual = 0.0, .maxSweeps = kSweeps});
        const TileOfTree tile(room.tree, room.links);
        std::vector<glm::dvec4> b0;
        for (const gpu::PatchRecord& patch : tile.patches) b0.push_back(glm::dvec4(patch.emission));
        const twin::Solution twin = twin::solve(tile.view, b0, kSweeps);
        const auto [irradiance, radiosity] = sweep(tile.view, kSweeps);
        const std::vector<double> exact = solveDense(denseFactors(room.tree, room.links), room.rho, room.b0);
        double reflected = 0.0;
        for (u32 i = 0; i < room.tree.patchCount(); ++i) {
            for (int c = 0; c < 4; ++c) {
                // The tile's areas, and with them the weights of the pull, are floats; so are the device's sums, and
                // its slopes half floats.
                const double half = linear ? 0x1.0p-12 : 0.0;
                EXPECT_NEAR(twin.radiosity[i][c], reference.radiosity[i][c], 1e-6 * reference.radiosity[i][c]) << i;
                EXPECT_NEAR(double(radiosity[i][c]), reference.radiosity[i][c],
                            (3e-6 + half) * reference.radiosity[i][c])
                    << i;
                // The reference gathers once more, after its last sweep: by then nothing changes.
                EXPECT_NEAR(double(irradiance[i][c]), reference.indirect[i][c],
                            (1e-5 + half) * reference.indirect[i][c])
                    << i;
            }
            EXPECT_NEAR(reference.radiosity[i].x, exact[i], 1e-6 * exact[i]) << i;
            reflected += reference.radiosity[i].x - room.b0[i];
            reds[linear].push_back(reference.radiosity[i].x);
        }
        EXPECT_GT(reflected / room.tree.patchCount(), 1.0) << "the links carry light";
    }
    double apart = 0.0;
    for (size_t i = 0; i < reds[0].size(); ++i) apart = std::max(apart, std::abs(reds[1][i] - reds[0][i]));
    EXPECT_GT(apart, 0.01) << "the moments matter";
}

} // namespace
} // namespace helio
