// SPDX-License-Identifier: Apache-2.0
// E_sky against sums in double: one radiance a sky patch, and linear ones with offsets.
#include "engine/stages/sky_energy.h"

#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/base/hash.h"
#include "engine/gpu/recorder.h"
#include "engine/gpu/transfer.h"
#include "tests/support/gpu_fixture.h"
#include "tests/support/tile_builder.h"

namespace helio {

namespace {

class SkyEnergyTest : public GpuTest
{
protected:
    static constexpr u32 kPatches = 300, kCells = 20;

    void SetUp() override
    {
        GpuTest::SetUp();
        for (u32 i = 0; i < kPatches; ++i) b_.patch({0, 0, 1}, 1.0f, glm::vec4(0.5f));
        Random random(3);
        const auto part = [&] { return float(2.0 * random.uniform() - 1.0); };
        rows_ = {0};
        for (u32 i = 0; i < kPatches; ++i) {
            for (u32 cell = 0; cell < kCells; ++cell) {
                if (i % 7 == 0 || random.uniform() < 0.5) continue; // some see nothing
                columns_.push_back(cell);
                factors_.push_back(float(random.uniform() / kCells));
                halves_.push_back({part(), part()});
                const auto bits = [](float x) { return u32(u16(std::int16_t(std::lround(x * 32767.0f)))); };
                offsets_.push_back(bits(float(halves_.back().x)) | bits(float(halves_.back().y)) << 16);
            }
            rows_.push_back(u32(columns_.size()));
        }
        for (u32 cell = 0; cell < kCells; ++cell)
            radiance_.push_back({glm::vec4(50, 60, 70, 80) + 10.0f * part(), {30.0f * part(), 30.0f * part()}});
    }

    std::vector<glm::vec4> run(bool linear, const UploadOptions& options = {.exactLinks = true})
    {
        TileView view = b_.view();
        view.skyRows = rows_;
        view.skyColumns = columns_;
        view.skyFactors = factors_;
        if (linear) view.skyOffsets = offsets_;
        view.skyPatches = skyPatches_;
        auto tile = uploadTile(context(), view, options);
        EXPECT_TRUE(tile.ok());
        const Buffer radiance = makeBuffer(context(), "radiance", skySenders(*tile, radiance_));
        const Buffer irradiance = makeBuffer(context(), "E_sky", std::vector<glm::vec4>(kPatches));
        FrameGraph graph("sky");
        (void)addSkyEnergy(graph, *tile, graph.import(radiance), graph.import(irradiance));
        EXPECT_TRUE(graph.compile(context()).ok());
        Recorder recorder(context());
        recorder.begin();
        graph.execute(recorder);
        recorder.submitAndWait();
        return downloadItems<glm::vec4>(context(), irradiance);
    }

    /// The offsets are halves of what is stored, which is in [-1, 1].
    void expect(const std::vector<glm::vec4>& result, bool linear) const
    {
        for (u32 i = 0; i < kPatches; ++i)
            for (int c = 0; c < 4; ++c) {
                double sum = 0.0;
                for (u32 k = rows_[i]; k < rows_[i + 1]; ++k) {
                    const SkyRadiance& sky = radiance_[columns_[k]];
                    const double slope = double(glm::dot(glm::dvec2(sky.slope), 0.5 * halves_[k]));
                    sum += double(factors_[k]) * (double(sky.mean[c]) + (linear ? slope : 0.0));
                }
                // Half a step of the offsets, 1.5e-5, times slopes of at most 30, which are rounded to half floats.
                EXPECT_NEAR(result[i][c], std::numbers::pi * sum, (linear ? 3e-3 : 1e-3) + 1e-5 * sum) << i;
            }
    }

    TileBuilder b_;
    std::vector<u32> rows_, columns_, offsets_;
    std::vector<float> factors_;
    std::vector<glm::dvec2> halves_;
    std::vector<SkyRadiance> radiance_;
    std::vector<gpu::SkyPatchRecord> skyPatches_ = std::vector<gpu::SkyPatchRecord>(kCells);
};

TEST_F(SkyEnergyTest, OneRadianceASkyPatch)
{
    expect(run(false), false);
}

TEST_F(SkyEnergyTest, RadianceLinearAcrossSkyPatches)
{
    expect(run(true), true);
}

TEST_F(SkyEnergyTest, ShortLinksStayWithinTheirRounding)
{
    for (const bool linear : {false, true}) {
        const std::vector<glm::vec4> exact = run(linear), rounded = run(linear, {});
        double square = 0.0, all = 0.0;
        for (u32 i = 0; i < kPatches; ++i) {
            square += std::pow(double(rounded[i].a - exact[i].a), 2.0);
            all += std::pow(double(exact[i].a), 2.0);
        }
        EXPECT_LT(std::sqrt(square / all), 1.5e-3);
        EXPECT_GT(square, 0.0);
    }
}

} // namespace

} // namespace helio
