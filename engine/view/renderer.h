// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>
#include <glm/vec4.hpp>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/format/pack.h"
#include "engine/gpu/context.h"
#include "engine/gpu/recorder.h"
#include "engine/graph/frame_graph.h"
#include "engine/stages/histogram.h"
#include "engine/stages/sun_view.h"
#include "engine/stream/tile_tables.h"
#include "engine/view/camera.h"
#include "engine/view/light_state.h"
#include "shaders/shared/view.h"

namespace helio {

/// How far the sweeps go.
struct SolveOptions
{
    double residual = 1e-3; ///< stop when the relative, area-weighted residual is at most this, and the estimate of
                            ///< what is still missing half of it (residualOf, remainingErrorOf)
    u32 maxSweeps = 100;    ///< stop after this many in any case, >= 1
    u32 exactSweeps = 0;    ///< > 0: exactly this many plain sweeps, whatever the residual: so many reflections
    bool warmStart = false; ///< start from the last solution: fewer sweeps, but bits that depend on what came before
    bool operator==(const SolveOptions&) const = default;
};

struct RendererOptions
{
    SunViewOptions sun;
    SolveOptions solve;
    std::optional<HistogramVariant> histogram; ///< none: the one that is faster on the device
    UploadOptions upload;
    u64 mostSmoothBytes = ~u64(0); ///< of an array of the interpolated mesh; with more light is drawn by the patch
    /// Called with every graph that runs, in DOT (FrameGraph::dump), if it is given.
    std::function<void(const std::string& dot)> onGraph;
};

struct SolveReport
{
    bool cached = false; ///< nothing changed: the last solution stands, the figures are its own
    u32 sweeps = 0;
    double residual = 0.0; ///< of the radiosity that the last sweep started from; the result's own is smaller
    /// W/m2, a channel: no patch of that radiosity is further from the solution, rounding aside; the result's own are
    /// off by at most the contraction number, and its E_indirect by the row sum, times this. Infinite from number 1 on.
    glm::dvec4 bound{0.0};
    glm::dvec4 contraction{0.0};   ///< see Contraction::number
    bool accelerated = false;      ///< Chebyshev's semi-iteration (chebyshevRadius), in some channel at least
    glm::dvec4 meanRadiosity{0.0}; ///< W/m2, area-weighted mean of B over all patches
    u32 litPatches = 0;            ///< patches that face the sun
    u32 flaggedPatches = 0;        ///< of them, lit by an ancestor's ratio: too few texels, or grazing
    u32 excessPatches = 0;         ///< of them, more texels than their area explains; clamped
    double sunTexel = 0.0;         ///< m
    u32 sunViews = 0, sunWidth = 0, sunHeight = 0;
    u32 sunSamples = 0;           ///< rasters whose counts add up, see Renderer::refineSun
    std::vector<PassTime> stages; ///< milliseconds on the device: sun raster, histogram, sun energy, sky, gather
};

/// What a picture shows besides the city.
struct ViewOptions
{
    u32 mode = gpu::kModeFinal; ///< gpu::kMode...
    u32 picked = 0;             ///< patch whose links kModeLinks shows
    u32 samples = 1;            ///< samples a pixel along each axis, 1..4; forced to 1 for ids and depth
    bool smoothLight = true; ///< final: interpolate E_sky and E_indirect over coplanar patches (display only), if the
                             ///< device can hold that; else pictureNote() says so
    bool display = true;     ///< final: tints, haze, sky, reflecting panes; false: plain radiance, uniform sky
    double exposureStops = 0.0; ///< added to the automatic exposure
};

/// A picture on the host, rows from the top.
struct Picture
{
    u32 width = 0, height = 0;
    std::vector<u8> display;       ///< RGBA, sRGB
    std::vector<glm::vec4> values; ///< linear, mean of the samples: see addForward for the unit of each mode
    std::vector<PassTime> passes;
};

/// Light of every patch, W/m2: linear r, g, b, broadband solar.
struct LightTables
{
    std::vector<glm::vec4> sun, sky, indirect, radiosity;
};

/// A city on a device: solves its light and draws it. One thread at a time. The context must outlive it.
class Renderer
{
public:
    /// Uploads the pack's tile. Errors: see uploadTile.
    static Result<std::unique_ptr<Renderer>> create(Context& context, const Pack& pack,
                                                    const RendererOptions& options = {});
    /// The same for a tile in memory, which must outlive the renderer. northDeg: see PackIndex.
    static Result<std::unique_ptr<Renderer>> create(Context& context, const TileView& tile, double northDeg,
                                                    const RendererOptions& options = {});
    ~Renderer();
    Renderer(const Renderer&) = delete;
    Renderer& operator=(const Renderer&) = delete;

    /// Of the centre of the disc, as it appears: azimuth clockwise from true north, elevation above the horizon,
    /// degrees; dni W/m2, of the whole disc.
    void setSun(double azimuthDeg, double elevationDeg, double dni);
    /// dhi W/m2. `radiance`: of each cell of the pack's sky (skyCellCount), which must add up to dhi; none = uniform.
    /// The ground beyond the scene, where the pack has one, is lit by them and by the sun.
    void setSky(double dhi, std::vector<CellRadiance> radiance = {});
    void setEmission(bool on);
    /// Light of every patch in place of what the sun raster and the sky links give; null = theirs again. Pictures have
    /// no sun then: it is for tables.
    void setFirstLight(std::shared_ptr<const FirstLight> light);
    SolveOptions& solveOptions();
    const LightState& light() const;
    /// What lies on the device.
    const TileTables& tables() const;
    /// One sentence if the links may keep the sweeps from converging or their error from being bounded; else empty.
    const std::string& note() const;
    /// One sentence if a picture asked for interpolated light that the device cannot hold; else empty.
    const std::string& pictureNote() const;

    /// Stages 1 to 3, if the light changed since the last call. Blocks until the device is done.
    const SolveReport& solve();
    /// solve, and one more raster of the same sun with its texels shifted, so that E_sun gets finer with every call.
    const SolveReport& refineSun();
    /// E_sun, E_sky, E_indirect and B of every patch, after solve.
    LightTables readTables();
    /// Texels of each patch in the sun raster, after solve with the sun up.
    std::vector<u32> readCounts();

    /// Solves if needed, draws, waits, reads back.
    Picture render(const Camera& camera, u32 width, u32 height, const ViewOptions& view = {});
    /// For windows: solves if needed and adds stage 4 to a graph, which must be executed. Returns the display image
    /// (RGBA8, sRGB bytes; owned by the renderer, import it by displayImage()). One frame in flight: the previous one
    /// must be complete.
    Ref<Image> addFrame(FrameGraph& graph, const Camera& camera, u32 width, u32 height, const ViewOptions& view = {});
    /// The image behind addFrame's result.
    const Image& displayImage() const;

private:
    struct Impl;
    explicit Renderer(std::unique_ptr<Impl> impl);
    std::unique_ptr<Impl> impl_;
};

} // namespace helio
