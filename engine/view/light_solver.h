// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <optional>

#include "engine/gpu/recorder.h"
#include "engine/stages/acceleration.h"
#include "engine/stages/draw_list.h"
#include "engine/stages/gather.h"
#include "engine/stages/histogram.h"
#include "engine/stages/sun_view.h"
#include "engine/view/light_state.h"
#include "engine/view/renderer.h"

namespace helio {

/// The stage of the report that a pass belongs to; `other`: that of passes which any stage may have (fills, read
/// backs).
std::string stageOf(const std::string& pass, const std::string& other);

/// Stages 1 to 3 with the buffers that hold their results. Runs only what a change of the light asks for: the sun
/// raster, the histogram and E_sun when the sun moved; E_sky when the sky changed, or the sun where it lights the
/// ground beyond the scene; the sweeps when either did.
class LightSolver
{
public:
    LightSolver(Context& context, const TileTables& tile, const RendererOptions& options);

    /// Blocks until the device is done.
    const SolveReport& solve(const LightState& light);

    /// solve, and one more sample of the sun raster with its texels shifted: a sun that stands still gets finer with
    /// every call. Starts from the last solution. Nothing more than solve without sun.
    const SolveReport& refineSun(const LightState& light);

    /// How often the light was worked out: as long as it stays the same, so does the light.
    u64 solveCount() const { return solveCount_; }
    RendererOptions& options() { return options_; }
    const SunView& sunView() const { return sunView_; }
    const Image& shadow() const { return *shadow_; }
    const Buffer& counts() const { return counts_; }               ///< u32 a patch
    const Buffer& sun() const { return sun_; }                     ///< vec4 a patch
    const Buffer& sky() const { return sky_; }                     ///< vec4 a patch
    const Buffer& indirect() const { return irradiance_; }         ///< vec4 a node; E_indirect at the patches
    const Buffer& radiosity() const { return senders_[current_]; } ///< vec4 a patch first, see shaders/shared/solve.h
    /// The same before the last sweep.
    const Buffer& radiosityBefore() const { return senders_[1 - current_]; }
    const SpectralBounds& spectrum() const { return spectrum_; } ///< zero where the contraction number is below a half

private:
    void solveSun(const LightState& light);
    void sampleSun(const LightState& light);
    void solveSky(const LightState& light);
    void takeGiven(const FirstLight& light);
    void estimateSpectrum();
    void firstLight(const LightState& light, bool warm);
    void sweep(const LightState& light, bool warm);
    void fitImages();
    void execute(FrameGraph& graph, bool timed);
    void run(FrameGraph& graph, const char* other);
    LightRefs lightIn(FrameGraph& graph) const;
    /// Adds a sweep; afterwards the other array of senders is the newest.
    SweepResult addSweepTo(FrameGraph& graph, LightRefs light, glm::vec4 weight = glm::vec4(1.0f));

    Context& context_;
    const TileTables& tile_;
    RendererOptions options_;
    Recorder recorder_;
    std::optional<LightState> solved_;
    SolveOptions solvedWith_;
    SolveReport report_;
    u64 solveCount_ = 0;
    HistogramVariant histogram_ = HistogramVariant::Columns;

    SpectralBounds spectrum_;
    glm::dvec4 radius_{0.0};       ///< see chebyshevRadius
    SunView fittedView_, sunView_; ///< sample 0, and the newest
    std::optional<Image> ids_, shadow_;
    Buffer counts_, density_, sun_, tally_, sky_, b0_, irradiance_, parts_, residual_;
    Buffer senders_[2]; ///< a sweep reads the one and writes the other
    u32 current_ = 0;   ///< the newest
    Buffer residualHost_, tallyHost_;
};

} // namespace helio
