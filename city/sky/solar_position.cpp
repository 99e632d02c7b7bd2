// SPDX-License-Identifier: Apache-2.0
#include "city/sky/solar_position.h"

#include <algorithm>
#include <cmath>
#include <initializer_list>
#include <numbers>
#include <span>

#include "city/sky/solar_terms.h"

namespace helio {
namespace {

using namespace solar;

constexpr double kDegree = std::numbers::pi / 180.0;

/// Coefficients by rising power of x.
double polynomial(double x, std::initializer_list<double> coefficients)
{
    double value = 0.0;
    for (const double* c = coefficients.end(); c != coefficients.begin();) value = value * x + *--c;
    return value;
}

double periodicSum(std::initializer_list<std::span<const PeriodicTerm>> powers, double t)
{
    double value = 0.0, power = 1.0;
    for (const std::span<const PeriodicTerm> terms : powers) {
        double sum = 0.0;
        for (const PeriodicTerm& term : terms) sum += term.amplitude * std::cos(term.phase + term.rate * t);
        value += sum * power;
        power *= t;
    }
    return value * 1e-8;
}

/// Nutation in longitude and in obliquity, rad.
struct Nutation
{
    double longitude = 0.0, obliquity = 0.0;
};

Nutation nutation(double centuries)
{
    const double t = centuries;
    const double arguments[5] = {polynomial(t, {297.85036, 445267.111480, -0.0019142, 1.0 / 189474.0}),
                                 polynomial(t, {357.52772, 35999.050340, -0.0001603, -1.0 / 300000.0}),
                                 polynomial(t, {134.96298, 477198.867398, 0.0086972, 1.0 / 56250.0}),
                                 polynomial(t, {93.27191, 483202.017538, -0.0036825, 1.0 / 327270.0}),
                                 polynomial(t, {125.04452, -1934.136261, 0.0020708, 1.0 / 450000.0})};
    Nutation sum;
    for (const NutationTerm& term : kNutation) {
        double angle = 0.0;
        for (int i = 0; i < 5; ++i) angle += term.multiple[i] * arguments[i];
        sum.longitude += (term.a + term.b * t) * std::sin(angle * kDegree);
        sum.obliquity += (term.c + term.d * t) * std::cos(angle * kDegree);
    }
    constexpr double kUnit = kDegree / 36e6; // 1e-4 arc seconds
    return {sum.longitude * kUnit, sum.obliquity * kUnit};
}

/// Mean obliquity of the ecliptic, rad (section 3.5).
double meanObliquity(double millennia)
{
    const double arcSeconds = polynomial(
        millennia / 10.0, {84381.448, -4680.93, -1.55, 1999.25, -51.38, -249.67, -39.05, 7.12, 27.87, 5.79, 2.45});
    return arcSeconds / 3600.0 * kDegree;
}

/// What the air lifts the sun by, degrees, from its true elevation (equation 42).
double refraction(double elevationDeg, const Site& site)
{
    constexpr double kDiscRadius = 0.26667, kAtHorizon = 0.5667; // degrees
    if (elevationDeg < -(kDiscRadius + kAtHorizon)) return 0.0;
    return site.pressure / 1010.0 * 283.0 / (273.0 + site.temperature) * 1.02 /
           (60.0 * std::tan((elevationDeg + 10.3 / (elevationDeg + 5.11)) * kDegree));
}

} // namespace

double standardPressure(double elevation)
{
    return 1013.25 * std::pow(1.0 - 2.25577e-5 * std::min(elevation, 11000.0), 5.25588);
}

SunPosition sunPosition(double julianDay, const Site& site, double deltaT)
{
    constexpr double kJ2000 = 2451545.0;
    const double days = julianDay - kJ2000, century = days / 36525.0;
    const double ephemerisCentury = (days + deltaT / 86400.0) / 36525.0, millennium = ephemerisCentury / 10.0;

    // The sun as seen from the Earth's centre: ecliptic longitude and latitude (3.2, 3.3), then equatorial (3.4-3.10).
    const double distance = periodicSum({kDistance0, kDistance1, kDistance2, kDistance3, kDistance4}, millennium);
    const Nutation shift = nutation(ephemerisCentury);
    const double aberration = -20.4898 / 3600.0 * kDegree / distance;
    const double longitude =
        periodicSum({kLongitude0, kLongitude1, kLongitude2, kLongitude3, kLongitude4, kLongitude5}, millennium) +
        std::numbers::pi + shift.longitude + aberration;
    const double latitude = -periodicSum({kLatitude0, kLatitude1}, millennium);
    const double obliquity = meanObliquity(millennium) + shift.obliquity;
    const double meanSidereal = std::fmod(
        polynomial(century, {280.46061837, 0.0, 0.000387933, -1.0 / 38710000.0}) + 360.98564736629 * days, 360.0);
    const double sidereal = meanSidereal * kDegree + shift.longitude * std::cos(obliquity);
    const double ascension = std::atan2(
        std::sin(longitude) * std::cos(obliquity) - std::tan(latitude) * std::sin(obliquity), std::cos(longitude));
    const double declination = std::asin(std::sin(latitude) * std::cos(obliquity) +
                                         std::cos(latitude) * std::sin(obliquity) * std::sin(longitude));

    // As seen from the site (3.11-3.13): parallax on the ellipsoid.
    constexpr double kFlattening = 0.99664719, kEarthRadius = 6378140.0;
    const double phi = site.latitudeDeg * kDegree;
    const double hour = sidereal + site.longitudeDeg * kDegree - ascension;
    const double parallax = 8.794 / 3600.0 * kDegree / distance;
    const double reduced = std::atan(kFlattening * std::tan(phi));
    const double x = std::cos(reduced) + site.elevation / kEarthRadius * std::cos(phi);
    const double y = kFlattening * std::sin(reduced) + site.elevation / kEarthRadius * std::sin(phi);
    const double across = std::cos(declination) - x * std::sin(parallax) * std::cos(hour);
    const double ascensionShift = std::atan2(-x * std::sin(parallax) * std::sin(hour), across);
    const double localDeclination =
        std::atan2((std::sin(declination) - y * std::sin(parallax)) * std::cos(ascensionShift), across);
    const double localHour = hour - ascensionShift;

    SunPosition sun;
    sun.distance = distance;
    const double sine =
        std::sin(phi) * std::sin(localDeclination) + std::cos(phi) * std::cos(localDeclination) * std::cos(localHour);
    sun.trueElevationDeg = std::asin(std::clamp(sine, -1.0, 1.0)) / kDegree;
    sun.elevationDeg = sun.trueElevationDeg + refraction(sun.trueElevationDeg, site);
    const double fromSouth = std::atan2(std::sin(localHour), std::cos(localHour) * std::sin(phi) -
                                                                 std::tan(localDeclination) * std::cos(phi));
    sun.azimuthDeg = std::fmod(fromSouth / kDegree + 180.0, 360.0);
    return sun;
}

} // namespace helio
