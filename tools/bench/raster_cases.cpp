// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/raster_cases.h"

#include <glm/geometric.hpp>

#include "engine/gpu/transfer.h"
#include "engine/stages/sun_raster.h"
#include "engine/view/renderer.h"
#include "tools/bench/box_city.h"

namespace helio {

namespace {

constexpr u32 kTriangles = 1000000, kSize = 2048;

void addSunCases(CaseList& cases, const BoxCity& city)
{
    SunScene& c = cases.keep(makeSunScene(cases.context(), city, kSize));
    const auto raster = [&](const FacingLists& lists) {
        return [&](FrameGraph& graph) {
            (void)addSunRaster(graph, c.tile, lists, c.sun, 0, {graph.import(c.ids), graph.import(c.depth)});
        };
    };
    // The same picture, outlines aside (see the stage's test).
    std::vector<std::vector<u32>> pictures;
    for (const FacingLists* lists : {&c.everything, &c.facing}) {
        FrameGraph graph("check");
        raster (*lists)(graph);
        Recorder recorder(cases.context());
        runGraph(cases.context(), recorder, graph);
        pictures.push_back(downloadTexels<u32>(cases.context(), c.ids));
    }
    u64 apart = 0;
    for (size_t k = 0; k < pictures[0].size(); ++k) apart += pictures[0][k] != pictures[1][k];
    HELIO_CHECK(apart < pictures[0].size() / 1000, apart, " texels differ");
    const auto withTriangles = [&](const char* name, const FacingLists& lists) {
        cases.addGraph(name, raster(lists), "sun raster");
        std::printf("%s: %llu triangles, %llu texels of %zu differ\n", name,
                    static_cast<unsigned long long>(lists.closed.triangleCount() + lists.open.triangleCount()),
                    static_cast<unsigned long long>(apart), pictures[0].size());
    };
    withTriangles("sun raster, everything", c.everything);
    withTriangles("sun raster, what faces the sun", c.facing);
    cases.addRatio(
        {"sun raster: what faces the sun over everything", "sun raster, everything", "sun raster, what faces the sun"});
}

struct FrameCase
{
    std::unique_ptr<Renderer> renderer;
    Camera camera;
};

void addFrameCases(CaseList& cases, const BoxCity& city)
{
    auto made = std::make_shared<FrameCase>();
    auto renderer = Renderer::create(cases.context(), city.view(), 0.0, {});
    HELIO_CHECK(renderer.ok(), renderer.ok() ? "" : renderer.error().message);
    made->renderer = std::move(*renderer);
    made->renderer->setSun(150.0, 40.0, 800.0);
    made->camera.eye = {-120.0, -160.0, 90.0};
    made->camera.target = {300.0, 300.0, 0.0};
    FrameCase& c = cases.keep(made);
    const auto frame = [&](const char* name, const ViewOptions& view) {
        if (!cases.wants(name)) return;
        auto& recorder = cases.keep(std::make_shared<Recorder>(cases.context()));
        cases.add(name, [&, view](CaseList::Figures&) {
            FrameGraph graph("frame");
            (void)c.renderer->addFrame(graph, c.camera, cases.options().width, cases.options().height, view);
            runGraph(cases.context(), recorder, graph);
            return deviceTime(recorder, "forward");
        });
    };
    frame("forward, shadows and light", {.smoothLight = false});
    frame("forward, interpolated light", {});
    frame("forward, albedo alone", {.mode = gpu::kModeAlbedo});
    cases.addRatio(
        {"forward: shadows and light to albedo alone", "forward, shadows and light", "forward, albedo alone"});
    cases.addRatio(
        {"forward: interpolated light to albedo alone", "forward, interpolated light", "forward, albedo alone"});
}

} // namespace

std::shared_ptr<SunScene> makeSunScene(Context& context, const BoxCity& city, u32 size)
{
    auto tables = uploadTile(context, city.view());
    HELIO_CHECK(tables.ok(), tables.ok() ? "" : tables.error().message);
    const glm::dvec3 towardsSun = glm::normalize(glm::dvec3(0.4, -0.6, 0.6));
    std::vector<Box> boxes;
    for (const DrawChunk& chunk : tables->chunks) boxes.push_back(chunk.box);
    auto c = std::make_shared<SunScene>();
    c->sun = fitSunView(boxes, towardsSun,
                        {.texel = 1e-3, .maxTexels = u64(size) * size, .maxViewSize = size, .maxViews = 1});
    const glm::mat4 clip = c->sun.clipFromWorld(0);
    FacingDraws draws = facingDraws(tables->chunks, clip, glm::vec4(towardsSun, 0.0));
    c->everything = FacingLists(context, {{}, visibleDraws(tables->chunks, clip)});
    c->facing = FacingLists(context, std::move(draws));
    c->tile = std::move(*tables);
    c->ids = Image(
        context, {"ids", c->sun.width, c->sun.height, kIdFormat, 1,
                  VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | VK_IMAGE_USAGE_STORAGE_BIT | VK_IMAGE_USAGE_TRANSFER_SRC_BIT});
    c->depth = Image(
        context, {"depth", c->sun.width, c->sun.height, kDepthFormat, 1, VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT});
    return c;
}

void addRasterCases(CaseList& cases)
{
    const bool sun = cases.wants("sun raster, everything") || cases.wants("sun raster, what faces the sun");
    const bool frame = cases.wants("forward, shadows and light") || cases.wants("forward, interpolated light") ||
                       cases.wants("forward, albedo alone");
    if (!sun && !frame) return;
    BoxCity& city = cases.keep(std::make_shared<BoxCity>(kTriangles));
    if (sun) addSunCases(cases, city);
    if (frame) addFrameCases(cases, city);
}

} // namespace helio
