// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/base/hash.h"
#include "city/model/polygon.h"

namespace helio::test {

/// Two polygons that look at each other.
struct PairRings
{
    Ring3 a, b;
};

/// R1 at z = 0 facing up, x0..x1 by y0..y1; R2 at z facing down, u0..u1 by v0..v1.
PairRings opposed(double x0, double x1, double y0, double y1, double z, double u0, double u1, double v0, double v1);
/// R1 at z = 0 facing up, x0..x1 by y0..y1; R2 at x = 0 facing +x, z0..z1 by v0..v1.
PairRings perpendicular(double x0, double x1, double y0, double y1, double z0, double z1, double v0, double v1);
/// Rectangles w1 x l and w2 x l that share an edge of length l, `angle` degrees between them.
PairRings hinged(double w1, double w2, double l, double angle);

/// Form factors of these rectangles by closed forms of 16 terms (Howell C-13 and C-15).
double closedOpposed(double x0, double x1, double y0, double y1, double z, double u0, double u1, double v0, double v1);
double closedPerpendicular(double x0, double x1, double y0, double y1, double z0, double z1, double v0, double v1);
/// Mean factor from the points of a unit edge, facing across, to a unit square 1 m above that begins over the edge:
/// the limit of a sliver (Howell B-3, averaged over the edge).
double pointLineMean();

/// The six sides of a box from the origin to `size`, facing inwards.
std::vector<Ring3> boxInside(const glm::dvec3& size);
Ring3 moved(const Ring3& ring, const glm::dvec3& offset);
/// The rings after one random rotation about the origin.
std::vector<Ring3> turnedAll(const std::vector<Ring3>& rings, Random& dice);
std::vector<Ring3> trianglesOf(const Ring3& ring);
/// A star-shaped ring of 3..9 corners, mostly concave, of about unit size in a random plane through the origin.
Ring3 randomRing(Random& dice);
/// Two of them, near or far, of like or unlike size; often one cuts the other's plane.
PairRings randomPair(Random& dice);

} // namespace helio::test
