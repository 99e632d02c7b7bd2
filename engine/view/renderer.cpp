// SPDX-License-Identifier: Apache-2.0
#include "engine/view/renderer.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>
#include <span>
#include <utility>

#include "engine/gpu/transfer.h"
#include "engine/graph/pass_context.h"
#include "engine/stages/shade.h"
#include "engine/stages/sun_raster.h"
#include "engine/stream/smooth_tables.h"
#include "engine/view/display.h"
#include "engine/view/legend.h"
#include "engine/view/light_solver.h"
#include "engine/view/patch_values.h"

namespace helio {

namespace {

/// Images of one picture size.
struct FrameImages
{
    u32 width = 0, height = 0, samples = 0;
    Image radiance, depth, display;
};

FrameImages makeFrameImages(Context& context, u32 width, u32 height, u32 samples)
{
    const VkImageUsageFlags readable = VK_IMAGE_USAGE_TRANSFER_SRC_BIT | VK_IMAGE_USAGE_SAMPLED_BIT;
    FrameImages f{width, height, samples, {}, {}, {}};
    f.radiance = Image(context, {"radiance", width * samples, height * samples, kRadianceFormat, 1,
                                 VK_IMAGE_USAGE_COLOR_ATTACHMENT_BIT | readable});
    f.depth = Image(context, {"depth", width * samples, height * samples, kDepthFormat, 1,
                              VK_IMAGE_USAGE_DEPTH_STENCIL_ATTACHMENT_BIT});
    f.display = Image(context, {"display", width, height, kDisplayFormat, 1, VK_IMAGE_USAGE_STORAGE_BIT | readable});
    return f;
}

std::vector<glm::vec4> averageSamples(const std::vector<glm::vec4>& texels, u32 width, u32 height, u32 samples)
{
    if (samples == 1) return texels;
    std::vector<glm::vec4> pixels(size_t(width) * height, glm::vec4(0.0f));
    const float share = 1.0f / float(samples * samples);
    for (u32 y = 0; y < height * samples; ++y)
        for (u32 x = 0; x < width * samples; ++x)
            pixels[size_t(y / samples) * width + x / samples] += share * texels[size_t(y) * width * samples + x];
    return pixels;
}

} // namespace

struct Renderer::Impl
{
    Impl(Context& c, const TileView& t, TileTables tables, double north, const RendererOptions& options)
        : context(c), view(t), northDeg(north), tile(std::move(tables)), solver(c, tile, options),
          viewRecord(c, {"view", sizeof(gpu::ViewRecord), Memory::Upload}), recorder(c),
          smooth(uploadSmoothMesh(c, {}, tile.reads, smoothBytes())),
          softLight(c, {"soft light", u64(tile.patchCount) * sizeof(glm::vec4)})
    {
        note = contractionNote(tile.contraction, solver.spectrum());
        ground.z = tile.chunks.empty() ? 0.0 : double(tile.chunks.front().box.lo.z);
        for (const DrawChunk& chunk : tile.chunks) ground.z = std::min(ground.z, double(chunk.box.lo.z));
        ground.rho = glm::dvec3(farGroundOf(t));
    }

    /// What the mesh of interpolated light may take in one array.
    u64 smoothBytes() { return std::min(context.facts().maxStorageBufferBytes, solver.options().mostSmoothBytes); }

    /// The mesh of interpolated light is made when a picture first asks for it. False: it is too large for the device.
    bool needSmoothMesh()
    {
        if (smooth.patchCount == 0 && smooth.tooLarge == 0) {
            smooth = uploadSmoothMesh(context, view, tile.reads, smoothBytes());
            if (smooth.tooLarge > 0)
                pictureNote = concat("light is drawn by the patch: interpolated it takes ", smooth.tooLarge >> 20,
                                     " MiB in one buffer, of which ", smoothBytes() >> 20, " MiB can be bound");
        }
        return smooth.tooLarge == 0;
    }

    std::optional<PictureSky> sky(bool display)
    {
        if (!display) return {};
        if (std::exchange(displaySkyOf, solver.solveCount()) != solver.solveCount())
            displaySky = pictureSky(tile.skyPatches, light);
        return displaySky;
    }

    /// Soft light for pictures, worked out anew when the light changed, or the colour of its sky.
    void addLight(FrameGraph& graph, ShadeInputs& in, const std::optional<PictureSky>& sky, bool interpolate)
    {
        in.light = graph.import(softLight);
        in.smooth = graph.import(smooth.values);
        const SoftLightOf now{solver.solveCount(), sky.has_value()};
        if (std::exchange(softLightOf, now) != now)
            in.light = addSoftLight(graph, tile, graph.import(solver.sky()), graph.import(solver.indirect()),
                                    glm::vec4(sky ? sky->tint : glm::dvec3(1.0), 1.0), in.light);
        if (interpolate && std::exchange(smoothLightOf, now) != now)
            in.smooth = addSmoothLight(graph, smooth, in.light);
    }

    /// What a debug view shows of the patches.
    const Buffer& shown(u32 mode)
    {
        switch (mode) {
        case gpu::kModeSun:
            return solver.sun();
        case gpu::kModeSky:
            return solver.sky();
        case gpu::kModeIndirect:
            return solver.indirect();
        default:
            return mode >= gpu::kModeLevel ? values : solver.radiosity();
        }
    }

    /// What a buffer says of the patches, which come first in it.
    std::vector<glm::vec4> readPatches(const Buffer& from)
    {
        return asItems<glm::vec4>(download(context, from, 0, u64(tile.patchCount) * sizeof(glm::vec4)));
    }

    /// The numbers that a mode shows in false colour, and the largest of them.
    void needValues(const ViewOptions& options)
    {
        std::vector<glm::vec4> shown;
        if (options.mode == gpu::kModeLevel) shown = patchLevels(view);
        if (options.mode == gpu::kModeLinks) shown = linksOfPatch(view, options.picked);
        if (options.mode == gpu::kModeError) {
            shown = expectedErrors(view, readPatches(solver.indirect()));
            HELIO_CHECK(shown.size() == tile.patchCount, "the pack has no expected errors");
        }
        if (options.mode == gpu::kModeResidual) {
            shown = readPatches(solver.radiosity());
            const std::vector<glm::vec4> before = readPatches(solver.radiosityBefore());
            for (size_t i = 0; i < shown.size(); ++i) shown[i] = glm::vec4(std::abs(shown[i].a - before[i].a));
        }
        largestValue = 1e-30;
        for (const glm::vec4& value : shown) largestValue = std::max(largestValue, double(value.x));
        values = makeBuffer(context, "patch values", shown);
    }

    void needImages(u32 width, u32 height, u32 samples)
    {
        if (images.width != width || images.height != height || images.samples != samples) {
            context.waitIdle(); // The old ones may still be on their way to a window.
            images = {};
            images = makeFrameImages(context, width, height, samples);
        }
    }

    Context& context;
    std::optional<Pack> pack; // keeps the mapped tile alive
    TileView view;
    double northDeg;
    FarGround ground; // at the lowest point of what is drawn
    TileTables tile;
    LightSolver solver;
    std::string note, pictureNote;
    LightState light;
    Buffer viewRecord;
    Recorder recorder;
    SmoothTables smooth; // empty until it is needed
    Buffer softLight;    // vec4 a patch
    struct SoftLightOf
    {
        u64 solveCount;
        bool display;
        bool operator==(const SoftLightOf&) const = default;
    };
    std::optional<SoftLightOf> softLightOf, smoothLightOf; // of what the buffers hold
    PictureSky displaySky;
    u64 displaySkyOf = 0; // solveCount
    FrameImages images;
    FacingLists drawn, smoothDrawn;
    Buffer values;
    double largestValue = 1.0;
};

Renderer::Renderer(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Renderer::~Renderer()
{
    impl_->context.waitIdle();
}

Result<std::unique_ptr<Renderer>> Renderer::create(Context& context, const TileView& tile, double northDeg,
                                                   const RendererOptions& options)
{
    auto tables = uploadTile(context, tile, options.upload);
    if (!tables) return tables.error();
    auto impl = std::make_unique<Impl>(context, tile, std::move(*tables), northDeg, options);
    std::unique_ptr<Renderer> renderer(new Renderer(std::move(impl)));
    renderer->setSun(180.0, 45.0, 800.0);
    return renderer;
}

Result<std::unique_ptr<Renderer>> Renderer::create(Context& context, const Pack& pack, const RendererOptions& options)
{
    auto renderer = create(context, pack.tile(), pack.index().northDeg, options);
    if (renderer) (*renderer)->impl_->pack = pack;
    return renderer;
}

void Renderer::setSun(double azimuthDeg, double elevationDeg, double dni)
{
    HELIO_CHECK(std::isfinite(azimuthDeg) && std::isfinite(elevationDeg) && std::isfinite(dni) && dni >= 0.0,
                "azimuth ", azimuthDeg, ", elevation ", elevationDeg, ", DNI ", dni);
    setSunDisc(impl_->light, sunDirection(azimuthDeg, elevationDeg, impl_->northDeg), dni);
}

void Renderer::setSky(double dhi, std::vector<CellRadiance> radiance)
{
    HELIO_CHECK(std::isfinite(dhi) && dhi >= 0.0, "DHI ", dhi);
    HELIO_CHECK(radiance.empty() || radiance.size() == skyCellCount(impl_->tile.skyPatches), radiance.size(),
                " radiances");
    impl_->light.dhi = dhi;
    impl_->light.skyRadiance = std::move(radiance);
}

void Renderer::setEmission(bool on)
{
    impl_->light.emission = on;
}
void Renderer::setFirstLight(std::shared_ptr<const FirstLight> light)
{
    const u32 count = impl_->tile.patchCount;
    HELIO_CHECK(!light || (light->sun.size() == count && light->sky.size() == count), count, " patches");
    impl_->light.given = std::move(light);
}

const std::string& Renderer::note() const
{
    return impl_->note;
}

const std::string& Renderer::pictureNote() const
{
    return impl_->pictureNote;
}

SolveOptions& Renderer::solveOptions()
{
    return impl_->solver.options().solve;
}
const LightState& Renderer::light() const
{
    return impl_->light;
}
const TileTables& Renderer::tables() const
{
    return impl_->tile;
}
const SolveReport& Renderer::solve()
{
    return impl_->solver.solve(impl_->light);
}

const SolveReport& Renderer::refineSun()
{
    return impl_->solver.refineSun(impl_->light);
}

LightTables Renderer::readTables()
{
    Impl& r = *impl_;
    return {r.readPatches(r.solver.sun()), r.readPatches(r.solver.sky()), r.readPatches(r.solver.indirect()),
            r.readPatches(r.solver.radiosity())};
}

std::vector<u32> Renderer::readCounts()
{
    return downloadItems<u32>(impl_->context, impl_->solver.counts());
}

Ref<Image> Renderer::addFrame(FrameGraph& graph, const Camera& camera, u32 width, u32 height,
                              const ViewOptions& options)
{
    Impl& r = *impl_;
    HELIO_CHECK(width > 0 && height > 0 && options.samples >= 1 && options.samples <= 4, width, " x ", height, ", ",
                options.samples, " samples");
    const SolveReport& report = r.solver.solve(r.light);
    const bool exact = options.mode == gpu::kModeId || options.mode == gpu::kModeDepth;
    const u32 samples = exact ? 1 : options.samples;
    const bool smooth = options.mode == gpu::kModeFinal && options.smoothLight && r.needSmoothMesh();
    r.needImages(width, height, samples);
    const bool numbers = options.mode >= gpu::kModeLevel;
    if (numbers) r.needValues(options);

    const glm::uvec2 size(width * samples, height * samples);
    const gpu::ForwardParams params =
        forwardParams(camera, double(width) / height, r.solver.sunView(), options.display);
    const std::optional<PictureSky> sky = r.sky(options.display);
    const gpu::ViewRecord record = viewRecord(camera, size, r.light, r.solver.sunView(), r.ground, sky);
    std::memcpy(r.viewRecord.mapped(), &record, sizeof(record));
    r.viewRecord.flush();
    const glm::vec4 eye(glm::vec3(camera.eye), 1.0f);
    std::span<const DrawChunk> chunks = r.tile.chunks;
    if (smooth) { // The refined mesh stands for the static one, which comes first.
        const auto isAsset = [](const DrawChunk& chunk) { return !isStaticDraw(chunk.draw); };
        chunks = chunks.subspan(size_t(std::find_if(chunks.begin(), chunks.end(), isAsset) - chunks.begin()));
    }
    r.drawn = FacingLists(r.context, facingDraws(chunks, params.clipFromWorld, eye));
    r.smoothDrawn =
        FacingLists(r.context, smooth ? facingDraws(r.smooth.chunks, params.clipFromWorld, eye) : FacingDraws{});

    ShadeInputs in;
    in.params = params;
    in.view = graph.import(r.viewRecord);
    in.shadow = graph.import(r.solver.shadow());
    in.shown = graph.import(r.shown(options.mode));
    in.mode = options.mode;
    in.light = in.smooth = in.shown; // not read
    if (options.mode == gpu::kModeFinal) r.addLight(graph, in, sky, smooth);
    in.emitters = r.tile.emits && r.light.emission;
    const ShadeTargets targets = addForward(graph, r.tile, r.drawn, r.smooth, r.smoothDrawn, in,
                                            {graph.import(r.images.radiance), graph.import(r.images.depth)});

    gpu::ToneParams tone{};
    tone.width = width;
    tone.height = height;
    tone.exposure = float(autoExposure(report.meanRadiosity, r.light) * std::exp2(options.exposureStops));
    tone.scale = float(numbers ? r.largestValue : falseColourScale(options.mode, report.meanRadiosity, r.light));
    return addTone(graph, targets.radiance, graph.import(r.images.display), options.mode, samples, tone);
}

const Image& Renderer::displayImage() const
{
    return impl_->images.display;
}

Picture Renderer::render(const Camera& camera, u32 width, u32 height, const ViewOptions& options)
{
    Impl& r = *impl_;
    FrameGraph graph("frame");
    (void)addFrame(graph, camera, width, height, options);
    const Status compiled = graph.compile(r.context);
    HELIO_CHECK(compiled.ok(), compiled.ok() ? "" : compiled.error().message, "\n", graph.dump());
    if (const auto& tell = r.solver.options().onGraph) tell(graph.dump());
    r.recorder.begin();
    graph.execute(r.recorder, true);
    r.recorder.submitAndWait();

    Picture picture;
    picture.width = width;
    picture.height = height;
    picture.passes = r.recorder.times();
    picture.display = downloadTexels<u8>(r.context, r.images.display);
    if (options.mode >= gpu::kModeLevel)
        drawLegend(picture, r.largestValue,
                   options.mode == gpu::kModeLevel   ? "levels"
                   : options.mode == gpu::kModeLinks ? "/m2"
                                                     : "W/m2");
    picture.values =
        averageSamples(downloadTexels<glm::vec4>(r.context, r.images.radiance), width, height, r.images.samples);
    return picture;
}

} // namespace helio
