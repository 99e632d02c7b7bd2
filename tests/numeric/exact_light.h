// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <span>
#include <vector>

#include "tests/numeric/fixtures.h"

namespace helio::test {

/// Form factors F_ij of faces that nothing occludes, by exchange(), row major.
std::vector<double> exactFactors(const std::vector<Face>& faces);

/// A strip of an endless cross-section; its lit side lies to the left of the way from a to b.
struct Strip
{
    glm::dvec2 a, b;
};
/// Form factors of strips that see each other whole, by Hottel's crossed strings, row major. Strips on one line
/// exchange nothing.
std::vector<double> crossedStrings(std::span<const Strip> strips);

/// Area-weighted mean of values over [begin, end).
double meanOf(std::span<const double> areas, std::span<const double> values, size_t begin, size_t end);

/// Exponent p of errors that go with h^p, from errors at h and h / 2.
double orderOf(double coarseError, double fineError);

/// The faces of a sphere of radius 1 seen from inside: an icosahedron whose triangles are cut in four `levels` times,
/// corners on the sphere; one group a face.
std::vector<Face> sphereInside(u32 levels);

} // namespace helio::test
