// SPDX-License-Identifier: Apache-2.0
#include "city/light/path_tracer.h"

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <glm/exponential.hpp>
#include <glm/geometric.hpp>
#include <mutex>
#include <numbers>

#include "city/base/check.h"
#include "city/base/hash.h"
#include "city/base/parallel.h"
#include "city/light/cosine_directions.h"
#include "city/light/sequence.h"
#include "shaders/shared/disc.h"

namespace helio {
namespace {

constexpr u32 kChunk = 16;               // patches
constexpr u32 kGroups = 32;              // enough for an error of the standard error of 1 / sqrt(2 x 31) = 13 %
constexpr double kRouletteWeight = 0.25; // half of what a light facade reflects: most paths end after three bounces

double largest(const glm::dvec4& v)
{
    return std::max(std::max(v.x, v.y), std::max(v.z, v.w));
}

/// Mean of the groups so far and the sum of squares about it (Welford 1962).
template <class T> struct Spread
{
    T mean{0.0}, squares{0.0};

    void add(const T& value, u32 count)
    {
        const T before = value - mean;
        mean += before / double(count);
        squares += before * (value - mean);
    }
    T error(u32 count) const { return glm::sqrt(squares / (double(count) * double(count - 1))); }
};

/// What a path or the mean of some paths brings.
struct Gathered
{
    double sun = 0.0;
    glm::dvec4 sky{0.0}, indirect{0.0};
};

/// One thread's paths.
class Walker
{
public:
    Walker(const NodeTree& tree, const Visibility& visibility, const PathOptions& options)
        : tree_(tree), visibility_(visibility), options_(options), sunFrame_(planeFrame(options.toSun)),
          sunUp_(options.dni > 0.0 && options.toSun.z > -options.sunRadius),
          plain_(options.farGround * (options.dhi + options.dni * double(gpu::discCosine(float(options.toSun.z),
                                                                                         float(options.sunRadius)))))
    {
    }

    /// The mean of `paths` paths of a patch whose points are shifted as the seed says.
    Gathered group(u32 patch, const PlaneFrame& frame, u32 paths, u64 seed)
    {
        const std::array<u32, 4> shift = digitalShift(seed);
        Random random(mixSeed(seed, 1));
        Gathered sum;
        for (u32 k = 0; k < paths; ++k) {
            const std::array<double, 4> x = shiftedSobol4(k, shift);
            const glm::dvec3 start = visibility_.pointOnPatch(patch, x[2], x[3]);
            sum.sun += sunAt(patch, start, random);
            const glm::dvec3 direction = cosineDirection(frame, x[0], x[1]);
            ++rays;
            if (options_.firstHand) {
                if (!visibility_.isBlocked(start, frame.normal, direction)) sum.sky += outside(direction);
                continue;
            }
            const RayHit hit = visibility_.trace(start, frame.normal, direction);
            if (hit.patch == kNoIndex)
                sum.sky += outside(direction);
            else
                sum.indirect += radiosityAt(hit, random);
        }
        return {sum.sun / paths, sum.sky / double(paths), sum.indirect / double(paths)};
    }

    u64 rays = 0, cutPaths = 0;

private:
    /// pi x the radiance that comes from outside the scene against a direction.
    glm::dvec4 outside(const glm::dvec3& direction) const
    {
        return direction.z > 0.0 ? glm::dvec4(options_.dhi) : plain_;
    }

    /// A direction to the sun: of a disc, every part of it alike.
    glm::dvec3 towardsSun(Random& random) const
    {
        if (options_.sunRadius == 0.0) return options_.toSun;
        const double r = std::sin(options_.sunRadius) * std::sqrt(random.uniform());
        const double phi = 2.0 * std::numbers::pi * random.uniform();
        return r * std::cos(phi) * sunFrame_.u + r * std::sin(phi) * sunFrame_.v +
               std::sqrt(1.0 - r * r) * sunFrame_.normal;
    }

    double sunAt(u32 patch, const glm::dvec3& point, Random& random)
    {
        const glm::dvec3& normal = tree_.nodes[patch].normal;
        if (!sunUp_ || glm::dot(normal, options_.toSun) <= -options_.sunRadius) return 0.0;
        const glm::dvec3 toSun = towardsSun(random);
        const double cosine = glm::dot(normal, toSun);
        if (cosine <= 0.0 || toSun.z <= 0.0) return 0.0;
        ++rays;
        return visibility_.isBlocked(point, normal, toSun) ? 0.0 : options_.dni * cosine;
    }

    /// An estimate of the radiosity where a ray ends.
    glm::dvec4 radiosityAt(RayHit hit, Random& random)
    {
        glm::dvec4 sum(0.0), weight(1.0);
        for (u32 bounce = 0; hit.front && !tree_.patches[hit.patch].covered; ++bounce) {
            const Patch& patch = tree_.patches[hit.patch];
            if (options_.emission) sum += weight * patch.emission;
            weight *= patch.rho;
            const double heaviest = largest(weight);
            if (heaviest < kRouletteWeight) {
                if (random.uniform() * kRouletteWeight >= heaviest) break;
                weight *= kRouletteWeight / heaviest;
            }
            if (bounce == kMostBounces) {
                ++cutPaths;
                break;
            }
            sum += weight * sunAt(hit.patch, hit.point, random);
            const PlaneFrame frame = planeFrame(tree_.nodes[hit.patch].normal);
            const double x = random.uniform(), y = random.uniform();
            const glm::dvec3 direction = cosineDirection(frame, x, y);
            ++rays;
            hit = visibility_.trace(hit.point, frame.normal, direction);
            if (hit.patch == kNoIndex) {
                sum += weight * outside(direction);
                break;
            }
        }
        return sum;
    }

    const NodeTree& tree_;
    const Visibility& visibility_;
    const PathOptions& options_;
    const PlaneFrame sunFrame_;
    const bool sunUp_;
    const glm::dvec4 plain_; ///< exitance of the plain beyond the scene
};

} // namespace

PathReference tracePaths(const NodeTree& tree, const Visibility& visibility, const PathOptions& options)
{
    HELIO_CHECK(options.samples >= 2 && options.samples <= 1u << 30, "samples = ", options.samples);
    HELIO_CHECK(std::abs(glm::dot(options.toSun, options.toSun) - 1.0) < 1e-6, "toSun is no unit vector");
    PathReference out;
    // Sobol points are well spread in powers of two; with few paths each is a group of its own.
    const u32 perGroup = std::bit_floor(std::max(1u, options.samples / kGroups));
    out.groups = (options.samples + perGroup - 1) / perGroup;
    out.samples = out.groups * perGroup;
    out.patches.resize(tree.patchCount());
    std::mutex mutex;
    std::atomic<bool> stopped{false};
    u32 done = 0;
    parallelFor(tree.patchCount(), kChunk, options.jobs, [&](u32 begin, u32 end) {
        Walker walker(tree, visibility, options);
        for (u32 patch = begin; patch < end && !stopped; ++patch) {
            if (tree.patches[patch].covered) continue;
            const PlaneFrame frame = planeFrame(tree.nodes[patch].normal);
            const u64 seed = mixSeed(mixSeed(options.seed, 0xbeac), patch);
            Spread<double> sun;
            Spread<glm::dvec4> sky, indirect, total;
            for (u32 g = 1; g <= out.groups; ++g) {
                const Gathered mean = walker.group(patch, frame, perGroup, mixSeed(seed, g));
                sun.add(mean.sun, g);
                sky.add(mean.sky, g);
                indirect.add(mean.indirect, g);
                total.add(mean.indirect + mean.sun + mean.sky, g);
            }
            out.patches[patch] = {sun.mean,
                                  sun.error(out.groups),
                                  sky.mean,
                                  sky.error(out.groups),
                                  indirect.mean,
                                  indirect.error(out.groups),
                                  total.error(out.groups)};
        }
        const std::lock_guard lock(mutex);
        out.rays += walker.rays;
        out.cutPaths += walker.cutPaths;
        done += end - begin;
        if (options.progress && !options.progress(double(done) / double(tree.patchCount()))) stopped = true;
    });
    out.complete = !stopped;
    return out;
}

} // namespace helio
