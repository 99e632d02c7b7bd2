// SPDX-License-Identifier: Apache-2.0
// Interpolated light on the device against its twin in double precision.
#include <algorithm>
#include <cmath>
#include <glm/common.hpp>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/stages/shade.h"
#include "engine/stream/smooth_mesh.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/smooth_twin.h"
#include "tests/support/wall_builder.h"

namespace helio {

namespace {

class SmoothLightTest : public GpuTest
{
};

/// One mean a channel that linear senders may have left below zero.
std::vector<glm::vec4> randomLight(Random& random, size_t count)
{
    const std::vector<glm::dvec4> means = twin::randomMeans(random, count);
    std::vector<glm::vec4> light(means.begin(), means.end());
    for (int c = 0; c < 4; ++c) light[size_t(c)][c] = -5.0f;
    return light;
}

TEST_F(SmoothLightTest, AgreesWithTheTwin)
{
    Random random(5);
    WallBuilder b;
    b.everything(random, 400);
    const TileView view = b.view();
    const SmoothMesh mesh = buildSmoothMesh(b.vertices, b.indices, b.patches, {});
    const std::vector<glm::vec4> means = randomLight(random, b.patches.size());
    const std::vector<glm::dvec4> expected =
        twin::smoothLight(mesh, std::vector<glm::dvec4>(means.begin(), means.end()));
    const Buffer meansBuffer = makeBuffer(context(), "means", means);
    for (const Reads reads : {Reads::Texels, Reads::Images, Reads::Storage}) {
        if (!canRead(context(), reads, mesh.indices.size())) continue;
        const SmoothTables tables = uploadSmoothMesh(context(), view, reads, context().facts().maxStorageBufferBytes);
        EXPECT_EQ(tables.reads, reads);
        Recorder recorder(context());
        for (int run = 0; run < 2; ++run) { // the second starts from the values of the first
            FrameGraph graph("smooth");
            (void)addSmoothLight(graph, tables, graph.import(meansBuffer));
            ASSERT_TRUE(graph.compile(context()).ok());
            recorder.begin();
            graph.execute(recorder, false);
            recorder.submitAndWait();
        }
        const auto values = downloadItems<glm::vec4>(context(), tables.values);
        ASSERT_EQ(values.size(), expected.size());
        for (size_t i = 0; i < expected.size(); ++i)
            for (int c = 0; c < 4; ++c) {
                // Values are differences of means: the error is that of the largest.
                const double largest = c == 2 ? 1e4 : 100.0;
                EXPECT_NEAR(double(values[i][c]), expected[i][c], 1e-5 * largest) << i << ", reads " << int(reads);
                EXPECT_GE(values[i][c], 0.0f);
            }
    }
}

} // namespace

} // namespace helio
