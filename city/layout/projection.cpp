// SPDX-License-Identifier: Apache-2.0
#include "city/layout/projection.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <numbers>

#include "city/base/check.h"

namespace helio {

namespace {

constexpr double kSemiMajor = 6378137.0; // m, WGS 84
constexpr double kFlattening = 1.0 / 298.257223563;
constexpr double kN = kFlattening / (2.0 - kFlattening); // third flattening
constexpr double kN2 = kN * kN, kN3 = kN2 * kN, kN4 = kN3 * kN, kN5 = kN4 * kN, kN6 = kN5 * kN;
constexpr double kRectifyingRadius = kSemiMajor / (1.0 + kN) * (1.0 + kN2 / 4.0 + kN4 / 64.0 + kN6 / 256.0);
constexpr double kRadian = std::numbers::pi / 180.0;

// Karney 2011, eq. 35.
constexpr std::array<double, 6> kAlpha{
    kN / 2.0 - 2.0 * kN2 / 3.0 + 5.0 * kN3 / 16.0 + 41.0 * kN4 / 180.0 - 127.0 * kN5 / 288.0 + 7891.0 * kN6 / 37800.0,
    13.0 * kN2 / 48.0 - 3.0 * kN3 / 5.0 + 557.0 * kN4 / 1440.0 + 281.0 * kN5 / 630.0 - 1983433.0 * kN6 / 1935360.0,
    61.0 * kN3 / 240.0 - 103.0 * kN4 / 140.0 + 15061.0 * kN5 / 26880.0 + 167603.0 * kN6 / 181440.0,
    49561.0 * kN4 / 161280.0 - 179.0 * kN5 / 168.0 + 6601661.0 * kN6 / 7257600.0,
    34729.0 * kN5 / 80640.0 - 3418889.0 * kN6 / 1995840.0,
    212378941.0 * kN6 / 319334400.0};
// Karney 2011, eq. 36.
constexpr std::array<double, 6> kBeta{
    kN / 2.0 - 2.0 * kN2 / 3.0 + 37.0 * kN3 / 96.0 - kN4 / 360.0 - 81.0 * kN5 / 512.0 + 96199.0 * kN6 / 604800.0,
    kN2 / 48.0 + kN3 / 15.0 - 437.0 * kN4 / 1440.0 + 46.0 * kN5 / 105.0 - 1118711.0 * kN6 / 3870720.0,
    17.0 * kN3 / 480.0 - 37.0 * kN4 / 840.0 - 209.0 * kN5 / 4480.0 + 5569.0 * kN6 / 90720.0,
    4397.0 * kN4 / 161280.0 - 11.0 * kN5 / 504.0 - 830251.0 * kN6 / 7257600.0,
    4583.0 * kN5 / 161280.0 - 108847.0 * kN6 / 3991680.0,
    20648693.0 * kN6 / 638668800.0};

// Tangent of the conformal latitude (eqs. 7-9).
double conformalTangent(double tangent)
{
    const double e = std::sqrt(kFlattening * (2.0 - kFlattening));
    const double secant = std::hypot(1.0, tangent);
    const double sigma = std::sinh(e * std::atanh(e * tangent / secant));
    return tangent * std::hypot(1.0, sigma) - sigma * secant;
}

// xi (north) and eta (east) of the Krueger plane, from the equator, in units of the rectifying radius.
glm::dvec2 toPlane(double latitudeDeg, double longitudeDeg)
{
    const double lambda = longitudeDeg * kRadian;
    const double tangent = conformalTangent(std::tan(latitudeDeg * kRadian));
    const double xi = std::atan2(tangent, std::cos(lambda));
    const double eta = std::asinh(std::sin(lambda) / std::hypot(tangent, std::cos(lambda)));
    glm::dvec2 plane(xi, eta);
    for (int j = 0; j < 6; ++j) {
        const double m = 2.0 * (j + 1);
        plane += kAlpha[size_t(j)] *
                 glm::dvec2(std::sin(m * xi) * std::cosh(m * eta), std::cos(m * xi) * std::sinh(m * eta));
    }
    return plane;
}

// The first run of four digits or more after "EPSG" (a version of the register may stand before it); empty without.
std::string_view epsgCodeOf(std::string_view crs)
{
    const auto isDigit = [](char c) { return c >= '0' && c <= '9'; };
    size_t begin = crs.find("EPSG");
    if (begin == std::string_view::npos) return {};
    while (begin < crs.size()) {
        size_t end = begin;
        while (end < crs.size() && isDigit(crs[end])) ++end;
        const std::string_view code = crs.substr(begin, end - begin);
        if (code.size() >= 4) return code == "7415" ? "28992" : code;
        begin = end + 1;
    }
    return {};
}

} // namespace

TransverseMercator::TransverseMercator(const GeoPoint& centre, double scale)
    : centre_(centre), radius_(scale * kRectifyingRadius)
{
    HELIO_CHECK(std::abs(centre.latitudeDeg) <= 90.0 && scale > 0.0, centre.latitudeDeg, " ", scale);
    northOffset_ = radius_ * toPlane(centre.latitudeDeg, 0.0).x;
}

glm::dvec2 TransverseMercator::forward(const GeoPoint& point) const
{
    const glm::dvec2 plane =
        toPlane(point.latitudeDeg, std::remainder(point.longitudeDeg - centre_.longitudeDeg, 360.0));
    return {radius_ * plane.y, radius_ * plane.x - northOffset_};
}

GeoPoint TransverseMercator::inverse(const glm::dvec2& point) const
{
    const double xi = (point.y + northOffset_) / radius_, eta = point.x / radius_;
    double xiPrime = xi, etaPrime = eta;
    for (int j = 0; j < 6; ++j) {
        const double m = 2.0 * (j + 1);
        xiPrime -= kBeta[size_t(j)] * std::sin(m * xi) * std::cosh(m * eta);
        etaPrime -= kBeta[size_t(j)] * std::cos(m * xi) * std::sinh(m * eta);
    }
    const double wanted = std::sin(xiPrime) / std::hypot(std::sinh(etaPrime), std::cos(xiPrime));
    // Newton's method of eqs. 19-21; its start is within 0.4 %, so that five steps end in the last bit.
    const double e2 = kFlattening * (2.0 - kFlattening);
    double tangent = wanted / (1.0 - e2);
    for (int step = 0; step < 5; ++step) {
        const double found = conformalTangent(tangent);
        tangent += (wanted - found) / std::hypot(1.0, found) * (1.0 + (1.0 - e2) * tangent * tangent) /
                   ((1.0 - e2) * std::hypot(1.0, tangent));
    }
    const double lambda = std::atan2(std::sinh(etaPrime), std::cos(xiPrime));
    return {std::atan(tangent) / kRadian, std::remainder(centre_.longitudeDeg + lambda / kRadian, 360.0)};
}

bool isGeographicCrs(std::string_view crs)
{
    for (const std::string_view name : {"4326", "CRS84", "4258", "4979"})
        if (crs.find(name) != std::string_view::npos) return true;
    return false;
}

bool isSameCrs(std::string_view a, std::string_view b)
{
    if (isGeographicCrs(a) || isGeographicCrs(b)) return isGeographicCrs(a) && isGeographicCrs(b);
    const std::string_view codeA = epsgCodeOf(a), codeB = epsgCodeOf(b);
    return codeA.empty() && codeB.empty() ? a == b : codeA == codeB;
}

std::optional<GeoPoint> placeOfUtm(std::string_view crs, const glm::dvec3& point)
{
    for (const std::string_view prefix : {"326", "327"}) {
        // "EPSG:32632", "urn:ogc:def:crs:EPSG::32632", ".../EPSG/0/32632"
        const size_t name = crs.find("EPSG");
        if (name == std::string_view::npos) return std::nullopt;
        size_t digits = name + 4;
        while (digits < crs.size() && !crs.substr(digits).starts_with(prefix)) {
            const char c = crs[digits];
            if (c != ':' && c != '/' && c != '0') break;
            ++digits;
        }
        if (!crs.substr(std::min(digits, crs.size())).starts_with(prefix)) continue;
        int zone = 0;
        const char* begin = crs.data() + digits + prefix.size();
        const auto [end, failure] = std::from_chars(begin, crs.data() + crs.size(), zone);
        if (failure != std::errc() || end - begin != 2 || zone < 1 || zone > 60) return std::nullopt;
        if (point.x < 1e5 || point.x > 9e5 || point.y < 0.0 || point.y > 1e7) return std::nullopt;
        const double falseNorthing = prefix == "327" ? 1e7 : 0.0;
        const TransverseMercator utm({0.0, 6.0 * zone - 183.0}, 0.9996);
        return utm.inverse({point.x - 5e5, point.y - falseNorthing});
    }
    return std::nullopt;
}

} // namespace helio
