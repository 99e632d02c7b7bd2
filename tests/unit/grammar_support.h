// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "city/grammar/derive.h"

namespace helio::test {

/// A free-standing footprint without neighbours.
inline Footprint footprintOf(Ring2 outer, double height, std::vector<Ring2> holes = {}, std::string id = "b")
{
    Footprint footprint;
    footprint.id = std::move(id);
    size_t edges = outer.size();
    for (const Ring2& hole : holes) edges += hole.size();
    footprint.covered.resize(edges);
    footprint.outline = {std::move(outer), std::move(holes)};
    footprint.height = height;
    return footprint;
}

/// A rectangle of x by y metres with its corner at the origin; the first edge runs along x and faces south.
inline Footprint boxFootprint(double x, double y, double height)
{
    return footprintOf({{0, 0}, {x, 0}, {x, y}, {0, y}}, height);
}

/// Covers a whole edge of a footprint up to a height.
inline void cover(Footprint& footprint, size_t edge, double height)
{
    footprint.covered.at(edge) = {{0.0, 1e3, height}};
}

/// Every asset is the unit cube, in asset units.
inline DeriveOptions unitAssets()
{
    DeriveOptions options;
    options.jobs = 1;
    options.assetBox = [](const std::string&) -> Result<AssetBox> { return AssetBox{{0, 0, 0}, {1, 1, 1}}; };
    return options;
}

inline Result<Derivation> deriveText(std::string_view rules, const std::vector<Footprint>& footprints,
                                     const DeriveOptions& options = unitAssets())
{
    const auto parsed = parseRules(rules, "t.cga");
    if (!parsed) return parsed.error();
    return derive(*parsed, footprints, options);
}

/// Derives rules that must be correct.
inline Derivation mustDerive(std::string_view rules, const std::vector<Footprint>& footprints,
                             const DeriveOptions& options = unitAssets())
{
    auto derivation = deriveText(rules, footprints, options);
    EXPECT_TRUE(derivation.ok()) << (derivation.ok() ? "" : derivation.error().message);
    return derivation.ok() ? std::move(*derivation) : Derivation{};
}

/// The first line of the error of rules that must be refused, at parsing or at derivation on a 10 x 10 x 10 m box.
inline std::string errorOf(std::string_view rules)
{
    const auto derivation = deriveText(rules, {boxFootprint(10, 10, 10)});
    return derivation.ok() ? "no error" : derivation.error().message.substr(0, derivation.error().message.find('\n'));
}

/// The leaves of a name, in order.
inline std::vector<const Shape*> leavesOf(const Derivation& derivation, std::string_view name)
{
    std::vector<const Shape*> leaves;
    for (const Shape& shape : derivation.shapes.shapes)
        if ((shape.polygonCount > 0 || shape.asset != kNoIndex) && derivation.shapes.names[shape.name] == name)
            leaves.push_back(&shape);
    return leaves;
}

inline double areaOf(const Derivation& derivation, const Shape& shape)
{
    double sum = 0.0;
    for (u32 k = 0; k < shape.polygonCount; ++k) sum += area(derivation.shapes.polygons[shape.polygonBegin + k]);
    return sum;
}

inline double areaOf(const Derivation& derivation, std::string_view name)
{
    double sum = 0.0;
    for (const Shape* leaf : leavesOf(derivation, name)) sum += areaOf(derivation, *leaf);
    return sum;
}

inline double totalArea(const Derivation& derivation)
{
    double sum = 0.0;
    for (const Polygon3& polygon : derivation.shapes.polygons) sum += area(polygon);
    return sum;
}

/// Smallest and largest corner of a leaf's polygons.
inline std::pair<glm::dvec3, glm::dvec3> boundsOf(const Derivation& derivation, const Shape& shape)
{
    glm::dvec3 low(INFINITY), high(-INFINITY);
    for (u32 k = 0; k < shape.polygonCount; ++k)
        for (const glm::dvec3& p : derivation.shapes.polygons[shape.polygonBegin + k].outer) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
    return {low, high};
}

/// Volume that all polygons enclose (divergence theorem): right only if they are closed and look outward.
inline double enclosedVolume(const Derivation& derivation)
{
    double sum = 0.0;
    for (const Polygon3& polygon : derivation.shapes.polygons)
        sum += glm::dot(polygon.outer[0], vectorArea(polygon)) / 3.0;
    return sum;
}

inline void expectNear(const glm::dvec3& value, const glm::dvec3& expected, double tolerance = 1e-9)
{
    for (int k = 0; k < 3; ++k) EXPECT_NEAR(value[k], expected[k], tolerance) << "axis " << k;
}

} // namespace helio::test
