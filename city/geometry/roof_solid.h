// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string>
#include <vector>

#include "city/base/result.h"
#include "city/geometry/roof.h"
#include "city/geometry/roof_base.h"
#include "city/geometry/straight_skeleton.h"

// Solids of roofs, piece by piece.
namespace helio {

/// A closed mesh whose faces share their corners.
struct RoofMesh
{
    std::vector<glm::dvec3> nodes; ///< m; z for a slope of 45 degrees (z scales with the tangent)
    struct Face
    {
        std::vector<u32> ring; ///< seen from outside
        std::vector<std::vector<u32>> holes;
        RoofPart part = RoofPart::Slope;
        u32 edge = kNoIndex;
    };
    std::vector<Face> faces;
};

/// Larger overhangs are cut to this, m.
inline constexpr double kMostOverhang = 50.0;

/// True if the pitch is in its range.
bool soundPitch(const RoofPitch& pitch);
/// Heights are `mesh` heights times this: the tangent, or what lifts the mesh's highest point to the given rise.
double slopeFactor(const RoofMesh& mesh, const RoofPitch& pitch);
/// Adds the mesh to the roof, heights times `factor`.
void append(Roof& roof, const RoofMesh& mesh, double factor);
/// Adds a slab of 0.1 m over the piece; the roof becomes a flat one for that reason.
void appendFlat(Roof& roof, const RoofBase& piece, const std::string& reason);
/// Adds fallback and reason to the roof's; the worst one stays.
void noteFallback(Roof& roof, RoofFallback fallback, const std::string& reason);

/// The solid between a base and its skeleton; height 0 is where the front has moved by `shift`. Faces of edges of speed
/// 0 are gables.
RoofMesh skeletonMesh(const RoofBase& base, const Skeleton& skeleton, std::span<const double> speeds, double shift);

/// The skeleton of a base; if need be, of the base 0.5 mm smaller, which `base` then becomes. `speedOf` (by the names
/// in RoofBase::edge, empty = 1 everywhere) gives the speeds, which come back in `speeds`.
Result<Skeleton> robustSkeleton(RoofBase& base, std::span<const double> speedOf, std::vector<double>& speeds);

/// A hip roof over one piece, with its fallbacks.
void appendHip(Roof& roof, const RoofBase& piece, const RoofPitch& pitch, double overhang);

} // namespace helio
