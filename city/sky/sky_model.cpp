// SPDX-License-Identifier: Apache-2.0
#include "city/sky/sky_model.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <glm/geometric.hpp>
#include <numbers>

#include "city/base/check.h"

namespace helio {
namespace {

constexpr u32 kTraditionalOvercast = 16;

struct Gradation
{
    double a, b;
};

struct Indicatrix
{
    double c, d, e;
};

// ISO 15469:2004, table 1: the six gradations, the six indicatrices, and the pair of each type.
constexpr std::array<Gradation, 6> kGradations{
    {{4.0, -0.70}, {1.1, -0.80}, {0.0, -1.00}, {-1.0, -0.55}, {-1.0, -0.32}, {-1.0, -0.15}}};
constexpr std::array<Indicatrix, 6> kIndicatrices{{{0.0, -1.0, 0.0},
                                                   {2.0, -1.5, 0.15},
                                                   {5.0, -2.5, 0.30},
                                                   {10.0, -3.0, 0.45},
                                                   {16.0, -3.0, 0.30},
                                                   {24.0, -2.8, 0.15}}};
constexpr std::array<std::array<u8, 2>, 15> kTypes{{{0, 0},
                                                    {0, 1},
                                                    {1, 0},
                                                    {1, 1},
                                                    {2, 0},
                                                    {2, 1},
                                                    {2, 2},
                                                    {2, 3},
                                                    {3, 1},
                                                    {3, 2},
                                                    {3, 3},
                                                    {4, 3},
                                                    {4, 4},
                                                    {5, 4},
                                                    {5, 5}}};

// Perez, Seals, Michalsky, "All-weather model for sky luminance distribution", Solar Energy 50 (1993), table 1: for
// each range of clearness the four coefficients of a, b, c, d, e.
constexpr std::array<double, 7> kClearness{1.065, 1.230, 1.500, 1.950, 2.800, 4.500, 6.200};
using Fit = std::array<double, 4>;
constexpr std::array<std::array<Fit, 5>, 8> kPerez{{
    {{{1.3525, -0.2576, -0.2690, -1.4366},
      {-0.7670, 0.0007, 1.2734, -0.1233},
      {2.8000, 0.6004, 1.2375, 1.0000},
      {1.8734, 0.6297, 0.9738, 0.2809},
      {0.0356, -0.1246, -0.5718, 0.9938}}},
    {{{-1.2219, -0.7730, 1.4148, 1.1016},
      {-0.2054, 0.0367, -3.9128, 0.9156},
      {6.9750, 0.1774, 6.4477, -0.1239},
      {-1.5798, -0.5081, -1.7812, 0.1080},
      {0.2624, 0.0672, -0.2190, -0.4285}}},
    {{{-1.1000, -0.2515, 0.8952, 0.0156},
      {0.2782, -0.1812, -4.5000, 1.1766},
      {24.7219, -13.0812, -37.7000, 34.8438},
      {-5.0000, 1.5218, 3.9229, -2.6204},
      {-0.0156, 0.1597, 0.4199, -0.5562}}},
    {{{-0.5484, -0.6654, -0.2672, 0.7117},
      {0.7234, -0.6219, -5.6812, 2.6297},
      {33.3389, -18.3000, -62.2500, 52.0781},
      {-3.5000, 0.0016, 1.1477, 0.1062},
      {0.4659, -0.3296, -0.0876, -0.0329}}},
    {{{-0.6000, -0.3566, -2.5000, 2.3250},
      {0.2937, 0.0496, -5.6812, 1.8415},
      {21.0000, -4.7656, -21.5906, 7.2492},
      {-3.5000, -0.1554, 1.4062, 0.3988},
      {0.0032, 0.0766, -0.0656, -0.1294}}},
    {{{-1.0156, -0.3670, 1.0078, 1.4051},
      {0.2875, -0.5328, -3.8500, 3.3750},
      {14.0000, -0.9999, -7.1406, 7.5469},
      {-3.4000, -0.1078, -1.0750, 1.5702},
      {-0.0672, 0.4016, 0.3017, -0.4844}}},
    {{{-1.0000, 0.0211, 0.5025, -0.5119},
      {-0.3000, 0.1922, 0.7023, -1.6317},
      {19.0000, -5.0000, 1.2438, -1.9094},
      {-4.0000, 0.0250, 0.3844, 0.2656},
      {1.0468, -0.3788, -2.4517, 1.4656}}},
    {{{-1.0500, 0.0289, 0.4260, 0.3590},
      {-0.3250, 0.1156, 0.7781, 0.0025},
      {31.0625, -14.5000, -46.1148, 55.3750},
      {-7.2312, 0.4050, 13.3500, 0.6234},
      {1.5000, -0.6426, 1.8564, 0.5636}}},
}};

glm::dvec3 aboveHorizon(const glm::dvec3& toSun)
{
    if (toSun.z >= 0.0) return toSun;
    const double level = std::hypot(toSun.x, toSun.y);
    return level > 0.0 ? glm::dvec3(toSun.x / level, toSun.y / level, 0.0) : glm::dvec3(1.0, 0.0, 0.0);
}

} // namespace

Result<SkyChoice> parseSky(std::string_view text)
{
    if (text == "uniform") return SkyChoice{};
    if (text == "perez") return SkyChoice{SkyKind::Perez, 1};
    u32 type = 0;
    if (text.starts_with("cie:")) {
        const char* end = text.data() + text.size();
        const auto [rest, error] = std::from_chars(text.data() + 4, end, type);
        if (error != std::errc() || rest != end) type = 0;
    }
    if (type < 1 || type > kTraditionalOvercast)
        return Error{concat("sky ", text, ": expected uniform, cie:N with N of 1 to 16, or perez")};
    return SkyChoice{SkyKind::Cie, type};
}

double SkyShape::operator()(const glm::dvec3& direction) const
{
    const double cosine = std::max(direction.z, 1e-6);
    if (traditionalOvercast) return (1.0 + 2.0 * cosine) / 3.0;
    const double toward = std::clamp(glm::dot(direction, toSun), -1.0, 1.0);
    const double gradation = 1.0 + a * std::exp(b / cosine);
    const double indicatrix = 1.0 + c * std::exp(d * std::acos(toward)) + offset + e * toward * toward;
    return std::max(0.0, gradation * indicatrix);
}

SkyShape cieSky(u32 type, const glm::dvec3& toSun)
{
    HELIO_CHECK(type >= 1 && type <= kTraditionalOvercast, "type ", type);
    SkyShape sky;
    sky.toSun = aboveHorizon(toSun);
    sky.traditionalOvercast = type == kTraditionalOvercast;
    if (sky.traditionalOvercast) return sky;
    const Gradation& g = kGradations[kTypes[type - 1][0]];
    const Indicatrix& i = kIndicatrices[kTypes[type - 1][1]];
    sky.a = g.a, sky.b = g.b, sky.c = i.c, sky.d = i.d, sky.e = i.e;
    sky.offset = -i.c * std::exp(i.d * std::numbers::pi / 2.0);
    return sky;
}

SkyShape perezSky(double dni, double dhi, double extraterrestrial, const glm::dvec3& toSun)
{
    HELIO_CHECK(dni >= 0.0 && dhi > 0.0 && extraterrestrial > 0.0, "DNI ", dni, ", DHI ", dhi, ", ", extraterrestrial);
    SkyShape sky;
    sky.toSun = aboveHorizon(toSun);
    const double zenith = std::acos(std::clamp(sky.toSun.z, 0.0, 1.0));
    const double cube = 1.041 * zenith * zenith * zenith;
    const double clearness = ((dhi + dni) / dhi + cube) / (1.0 + cube);
    const double zenithDeg = zenith * 180.0 / std::numbers::pi;
    const double airMass = 1.0 / (sky.toSun.z + 0.15 * std::pow(93.885 - zenithDeg, -1.253)); // Kasten 1966
    double brightness = std::clamp(dhi * airMass / extraterrestrial, 0.01, 0.6);
    if (clearness > 1.065 && clearness < 2.8) brightness = std::max(brightness, 0.2);

    const size_t range = size_t(std::upper_bound(kClearness.begin(), kClearness.end(), clearness) - kClearness.begin());
    const std::array<Fit, 5>& fits = kPerez[range];
    const auto at = [&](const Fit& f) { return f[0] + f[1] * zenith + brightness * (f[2] + f[3] * zenith); };
    sky.a = at(fits[0]), sky.b = at(fits[1]), sky.c = at(fits[2]), sky.d = at(fits[3]), sky.e = at(fits[4]);
    if (range == 0) {
        const Fit &c = fits[2], &d = fits[3];
        sky.c = std::exp(std::pow(brightness * (c[0] + c[1] * zenith), c[2])) - c[3];
        sky.d = -std::exp(brightness * (d[0] + d[1] * zenith)) + d[2] + brightness * d[3];
    }
    return sky;
}

std::vector<CellSky> domeRadiance(const SkyDome& dome, const SkyShape& shape, double dhi, bool linear)
{
    constexpr u32 kSamples = 8; // along each side of a cell, and more where cells are large
    const u32 samples = std::max(kSamples, u32(std::lround(std::sqrt(20000.0 / dome.cellCount()))));
    std::vector<CellSky> radiance(dome.cellCount());
    double irradiance = 0.0;
    for (u32 cell = 0; cell < dome.cellCount(); ++cell) {
        double sum = 0.0;
        glm::dvec2 moment(0.0), squares(0.0);
        for (u32 i = 0; i < samples; ++i)
            for (u32 j = 0; j < samples; ++j) {
                const glm::dvec3 direction = dome.pointOf(cell, (i + 0.5) / samples, (j + 0.5) / samples);
                const glm::dvec2 place = dome.placeIn(cell, direction);
                const double value = shape(direction);
                sum += value;
                moment += value * place;
                squares += place * place;
            }
        CellSky& sky = radiance[cell];
        sky.mean = sum / (samples * samples);
        if (linear) {
            sky.slope = moment / squares;
            const double steepest = std::abs(sky.slope.x) + std::abs(sky.slope.y);
            if (steepest > 2.0 * sky.mean) sky.slope *= 2.0 * sky.mean / steepest;
        }
        irradiance += sky.mean * dome.projectedSolidAngle(cell) + sky.slope.y * dome.projectedHeight(cell);
    }
    for (CellSky& sky : radiance) {
        if (irradiance <= 0.0) sky = {1.0, {}};
        const double scale = dhi / (irradiance > 0.0 ? irradiance : std::numbers::pi);
        sky.mean *= scale;
        sky.slope *= scale;
    }
    return radiance;
}

} // namespace helio
