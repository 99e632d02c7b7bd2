// SPDX-License-Identifier: Apache-2.0
#include "city/pack/reveal.h"

#include "city/base/check.h"

namespace helio {

std::vector<Polygon3> revealOf(const Ring3& ring, const glm::dvec3& normal, double depth)
{
    HELIO_CHECK(depth > 0.0, "depth = ", depth);
    std::vector<Polygon3> faces;
    Polygon3 back;
    for (size_t i = 0; i < ring.size(); ++i) {
        const glm::dvec3 a = ring[i], b = ring[(i + 1) % ring.size()];
        faces.push_back({{a, b, b - depth * normal, a - depth * normal}, {}});
        back.outer.push_back(a - depth * normal);
    }
    faces.push_back(std::move(back));
    return faces;
}

} // namespace helio
