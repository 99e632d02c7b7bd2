// SPDX-License-Identifier: Apache-2.0
#include "tests/screens/test_packs.h"

#include <array>
#include <memory>

#include "city/pack/pipeline.h"
#include "city/pack/writer.h"

namespace helio {
namespace {

constexpr std::array kAll{TestPack::City, TestPack::SceneS, TestPack::Midrise, TestPack::Rowhouse, TestPack::Tower};
constexpr std::array kNames{"city", "scene_s", "midrise", "rowhouse", "tower"};

std::filesystem::path folderOf(TestPack which)
{
    return std::filesystem::path(HELIO_SCREENS_PACKS) / concat(kNames[size_t(which)], ".pack");
}

Status bakeOne(TestPack which)
{
    const std::filesystem::path root = HELIO_SOURCE_FOLDER;
    BakeOptions options;
    if (which == TestPack::City) {
        options.input = root / "tests/screens/data/small_city.geojson";
    } else if (which == TestPack::SceneS) {
        options.input = root / "tests/data/scenes/S.obj";
        options.surfaces = root / "tests/data/scenes/S.csv";
    } else {
        const std::string name = kNames[size_t(which)];
        options.input = root / concat("tests/screens/data/", name, "_plans.geojson");
        options.rules = root / concat("city/rules/", name, ".cga");
        options.light.seed = 3;
    }
    const Result<BakeResult> baked = bake(options);
    if (!baked) return baked.error();
    std::error_code failure;
    std::filesystem::create_directories(HELIO_SCREENS_PACKS, failure);
    const Result<LinkBytes> written = writePack(baked->content, folderOf(which));
    return written ? Status(Nothing{}) : written.error();
}

} // namespace

Status bakeTestPacks()
{
    for (const TestPack which : kAll)
        if (Status baked = bakeOne(which); !baked) return baked;
    return Nothing{};
}

std::filesystem::path testPackFolder(TestPack which)
{
    const std::filesystem::path folder = folderOf(which);
    if (!std::filesystem::exists(folder)) {
        const Status baked = bakeOne(which);
        HELIO_CHECK(baked.ok(), baked.error().message);
    }
    return folder;
}

const Pack& testPack(TestPack which)
{
    static std::array<std::unique_ptr<Pack>, kAll.size()> packs;
    std::unique_ptr<Pack>& pack = packs[size_t(which)];
    if (!pack) pack = std::make_unique<Pack>(std::move(Pack::open(testPackFolder(which)).value()));
    return *pack;
}

Context& testContext()
{
    static const std::unique_ptr<Context> context = [] {
        ContextOptions options;
        options.device = "llvmpipe"; // the goldens are this driver's
        return std::move(Context::create(options).value());
    }();
    return *context;
}

Renderer& testRenderer(TestPack which)
{
    testContext(); // made first, so that it ends last
    static std::array<std::unique_ptr<Renderer>, kAll.size()> renderers;
    std::unique_ptr<Renderer>& renderer = renderers[size_t(which)];
    if (!renderer) renderer = std::move(Renderer::create(testContext(), testPack(which)).value());
    return *renderer;
}

} // namespace helio
