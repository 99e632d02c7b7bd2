// SPDX-License-Identifier: Apache-2.0
#include "city/sky/clear_sky.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace helio {

ClearSky clearSky(double elevationDeg, double turbidity, double height, double pressure, double extraterrestrial)
{
    if (!(elevationDeg > 0.0)) return {};
    const double sine = std::sin(elevationDeg * std::numbers::pi / 180.0);
    const double airMass =
        (1.0 / (sine + 0.50572 * std::pow(elevationDeg + 6.07995, -1.6364))) * pressure / 1013.25; // Kasten, Young 1989
    const double low = std::exp(-height / 8000.0), water = std::exp(-height / 1250.0);
    const double extra = turbidity - 1.0;
    const double global = (5.09e-5 * height + 0.868) * extraterrestrial * sine *
                          std::exp(-(3.92e-5 * height + 0.0387) * airMass * (low + water * extra));
    // The direct light of the formula and, where it would leave too little diffuse, the paper's upper limit.
    const double direct = (0.664 + 0.163 / low) * extraterrestrial * std::exp(-0.09 * airMass * extra);
    const double limit = global * (1.0 - (0.1 - 0.2 * std::exp(-turbidity)) / (0.1 + 0.882 / low)) / sine;
    ClearSky sky;
    sky.dni = std::clamp(direct, 0.0, std::max(0.0, limit));
    sky.dhi = std::max(0.0, global - sky.dni * sine);
    return sky;
}

} // namespace helio
