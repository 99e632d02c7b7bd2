// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/light/visibility.h"

namespace helio {

/// E_sun / DNI of each patch by shadow rays: cos(theta) times the fraction of `samples` points, stratified over the
/// patch, that see the sun; 0 where the sun is behind the patch, and everywhere when it is at or below the horizon (z
/// <= 0). `toSun` is a unit vector. The yardstick of the sun raster.
std::vector<double> raySun(const NodeTree& tree, const Visibility& visibility, const glm::dvec3& toSun, u32 samples,
                           u32 jobs = 0);

/// The same for several suns: [sun][patch].
std::vector<std::vector<double>> raySuns(const NodeTree& tree, const Visibility& visibility,
                                         std::span<const glm::dvec3> toSuns, u32 samples, u32 jobs = 0);

/// Unit vector to the sun from azimuth (clockwise from +y) and elevation, radians.
glm::dvec3 sunDirection(double azimuth, double elevation);

} // namespace helio
