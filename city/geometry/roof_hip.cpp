// SPDX-License-Identifier: Apache-2.0
#include <algorithm>

#include "city/geometry/roof_solid.h"

namespace helio {

Roof hipRoof(const Polygon2& base, const RoofPitch& pitch, double overhang)
{
    Roof roof;
    for (const RoofBase& piece : cleanBase(base)) {
        if (soundPitch(pitch))
            appendHip(roof, piece, pitch, std::clamp(overhang, 0.0, kMostOverhang));
        else
            appendFlat(roof, piece, "the pitch is out of range");
    }
    return roof;
}

} // namespace helio
