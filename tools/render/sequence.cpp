// SPDX-License-Identifier: Apache-2.0
#include "tools/render/sequence.h"

#include <cmath>
#include <cstdio>
#include <filesystem>

#include "engine/view/picture_file.h"

namespace helio {

namespace {

constexpr u32 kMinutesOfDay = 24 * 60;

/// Takes pictures one by one: files of their own, or places on a sheet that is written at the end.
class Film
{
public:
    explicit Film(const RenderOptions& o) : o_(o) {}

    Status add(const std::string& name, Picture picture)
    {
        if (o_.sheet) {
            pictures_.push_back(std::move(picture.display));
            return Nothing{};
        }
        const std::filesystem::path png(o_.png);
        const std::filesystem::path file =
            png.parent_path() / concat(png.stem().string(), "-", name, png.extension().string());
        return writePng(file, picture.width, picture.height, picture.display);
    }

    Status finish() const
    {
        if (!o_.sheet || pictures_.empty()) return Nothing{};
        const u32 count = u32(pictures_.size());
        const u32 columns = u32(std::ceil(std::sqrt(double(count)))), rows = (count + columns - 1) / columns;
        std::vector<u8> sheet(size_t(4) * columns * o_.width * rows * o_.height, 255);
        for (u32 k = 0; k < count; ++k)
            for (u32 y = 0; y < o_.height; ++y) {
                const size_t to = (size_t(k / columns * o_.height + y) * columns + k % columns) * o_.width * 4;
                std::copy_n(pictures_[k].begin() + size_t(y) * o_.width * 4, size_t(o_.width) * 4,
                            sheet.begin() + long(to));
            }
        return writePng(o_.png, columns * o_.width, rows * o_.height, sheet);
    }

private:
    const RenderOptions& o_;
    std::vector<std::vector<u8>> pictures_; ///< RGBA
};

/// rms difference of E_indirect (solar) over its mean, weighted by area.
double lagOf(const TileView& tile, const std::vector<glm::vec4>& seen, const std::vector<glm::vec4>& exact)
{
    double square = 0.0, mean = 0.0, area = 0.0;
    for (size_t i = 0; i < seen.size(); ++i) {
        const double weight = double(tile.patches[i].area);
        square += weight * std::pow(double(seen[i].a) - double(exact[i].a), 2.0);
        mean += weight * double(exact[i].a);
        area += weight;
    }
    return mean > 0.0 ? std::sqrt(square * area) / mean : 0.0;
}

} // namespace

Status renderPath(Renderer& renderer, const std::vector<PathKey>& path, const RenderOptions& o)
{
    Film film(o);
    const double first = path.front().seconds, length = path.back().seconds - first;
    for (u32 k = 0; k < o.frames; ++k) {
        const double seconds = first + (o.frames > 1 ? length * k / (o.frames - 1) : 0.0);
        Picture picture = renderer.render(cameraAt(path, seconds), o.width, o.height, viewOf(o));
        const SolveReport& report = renderer.solve();
        std::printf("Frame %u at %.3f s: %.1f ms for stage 4, %.1f for stages 1 to 3\n", k, seconds,
                    totalTime(picture.passes), report.cached ? 0.0 : totalTime(report.stages));
        char name[16];
        std::snprintf(name, sizeof(name), "%04u", k);
        if (const Status written = film.add(name, std::move(picture)); !written) return written;
    }
    return film.finish();
}

Status renderDay(Renderer& renderer, Context& context, const Pack& pack, const Camera& camera, const RenderOptions& o)
{
    renderer.solveOptions().warmStart = true;
    std::unique_ptr<Renderer> exact;
    if (o.lag) {
        RendererOptions options;
        options.solve.residual = 1e-6;
        if (o.sunTexel > 0.0) options.sun.texel = o.sunTexel;
        options.upload.exactLinks = o.exactLinks;
        Result<std::unique_ptr<Renderer>> made = Renderer::create(context, pack, options);
        if (!made) return made.error();
        exact = std::move(*made);
    }
    Film film(o);
    u32 shown = 0;
    for (u32 minute = 0; minute < kMinutesOfDay; minute += o.every) {
        DaylightOptions daylight = o.daylight;
        char time[8];
        std::snprintf(time, sizeof(time), "%02u:%02u", minute / 60, minute % 60);
        daylight.date = o.day;
        daylight.time = time;
        const Result<Daylight> light = daylightOver(pack, daylight);
        if (!light) return light.error();
        if (light->elevationDeg <= 0.0) continue;
        const auto set = [&](Renderer& r) {
            r.setSun(light->azimuthDeg, light->elevationDeg, light->dni);
            r.setSky(light->dhi, light->skyRadiance);
            r.setEmission(o.emission);
        };
        set(renderer);
        SolveReport report = renderer.solve();
        for (u32 k = 1; k < o.sunSamples; ++k) report = renderer.refineSun();
        std::printf("%s: sun azimuth %.1f elevation %.1f, DNI %.0f, DHI %.0f; %u sweeps, residual %.2g, %.0f ms", time,
                    light->azimuthDeg, light->elevationDeg, light->dni, light->dhi, report.sweeps, report.residual,
                    totalTime(report.stages));
        if (exact) {
            set(*exact);
            exact->solve();
            std::printf(", lag %.3f %%",
                        100.0 * lagOf(pack.tile(), renderer.readTables().indirect, exact->readTables().indirect));
        }
        std::printf("\n");
        std::fflush(stdout);
        ++shown;
        if (o.png.empty()) continue;
        Picture picture = renderer.render(camera, o.width, o.height, viewOf(o));
        const std::string name = concat(std::string(time, 2), std::string(time + 3, 2));
        if (const Status written = film.add(name, std::move(picture)); !written) return written;
    }
    if (shown == 0) return Error{concat("--day ", o.day, ": the sun does not rise")};
    return film.finish();
}

} // namespace helio
