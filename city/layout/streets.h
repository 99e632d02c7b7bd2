// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <vector>

#include "city/model/footprint.h"

namespace helio {

/// Per footprint and edge of its outer ring: the distance to the nearest street line that the edge faces, m; infinity
/// without one. An edge faces a line if from at least two of three points on it (a quarter, the half, three quarters) a
/// point of the line within 30 m is seen, under less than 60 degrees from the edge's normal, with no wall of any
/// footprint between.
std::vector<std::vector<double>> streetDistances(const Layout& layout);

/// Fills Footprint::onStreet from streetDistances; leaves it empty if the layout has no street lines.
void markStreets(Layout& layout);

} // namespace helio
