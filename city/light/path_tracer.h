// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <functional>

#include "city/light/visibility.h"

namespace helio {

/// The light and the effort of a reference by path tracing.
struct PathOptions
{
    glm::dvec3 toSun{0.0, 0.0, 1.0}; ///< unit vector; what is at or below the horizon (z <= 0) sends nothing
    double dni = 800.0;              ///< W/m2, direct normal irradiance, the same in all channels
    double sunRadius = 0.0;          ///< rad, of a disc of uniform radiance, which the horizon may cut; 0 = a point
    double dhi = 120.0;              ///< W/m2, of a sky that is uniform above the horizon
    /// Reflectance of an endless plain that paths meet when they leave below the horizon, in the sun and under the sky
    /// with nothing before them; 0 = black.
    glm::dvec4 farGround{0.0};
    bool emission = true;   ///< what patches emit themselves
    bool firstHand = false; ///< the light of sun and sky alone, in a fraction of the time: E_indirect is 0
    u32 samples = 256;      ///< paths a patch, at least 2
    u64 seed = 1;
    u32 jobs = 0; ///< threads, 0 = all cores; the result does not depend on it
    /// Gets the fraction done, from one thread at a time; false ends the work early. May be empty.
    std::function<bool(double)> progress = {};
};

/// Mean irradiance of one patch and its standard error, W/m2. The sun is the same in all channels.
struct PatchLight
{
    double sun = 0.0, sunError = 0.0;
    glm::dvec4 sky{0.0}, skyError{0.0}; ///< first-hand light from outside the scene: the sky and the plain beyond
    glm::dvec4 indirect{0.0}, indirectError{0.0};
    glm::dvec4 totalError{0.0}; ///< of the sum: its parts share rays, so their errors do not simply add
};

struct PathReference
{
    std::vector<PatchLight> patches;
    u32 samples = 0;  ///< paths a patch, rounded up to whole groups
    u32 groups = 0;   ///< groups of paths that the standard errors come from
    u64 rays = 0;     ///< traced, shadow rays included
    u64 cutPaths = 0; ///< ended at kMostBounces; 0 = no bias
    bool complete = false;
};

/// Where a path ends whatever it carries: what is cut off is below rho^1000 of its light.
inline constexpr u32 kMostBounces = 1000;

/// Irradiance of every patch by paths through the world that the links stand for: patches receive and send on their lit
/// side, diffusely with one reflectance, and block from both sides; backs are black. Nothing but the radiosity itself
/// is continuous over a patch here, so the difference to the links' solution holds all of its discretisation.
///
/// Path: a point of the patch and a cosine-distributed direction, stratified together (Sobol points with a random
/// digital shift for each group), so E_indirect is the mean radiosity that the rays meet. At every hit the emission,
/// the sun by a shadow ray, and a further cosine-distributed ray; a path that weighs less than 0.25 in every channel
/// ends at random or is raised to that (Russian roulette: no bias; Arvo and Kirk, "Particle transport and image
/// synthesis", 1990). Groups are independent; the standard error is that of their means. Covered patches receive
/// nothing and are black.
PathReference tracePaths(const NodeTree& tree, const Visibility& visibility, const PathOptions& options);

} // namespace helio
