// SPDX-License-Identifier: Apache-2.0
#include <gtest/gtest.h>

#include <glm/geometric.hpp>

#include "city/pack/reveal.h"

using namespace helio;

TEST(Reveal, SidesFaceInwardsAndTheBackFacesOut)
{
    // A tile of 2 x 3 m in a wall that faces south, 0.25 m deep.
    const Ring3 tile{{0, 0, 0}, {2, 0, 0}, {2, 0, 3}, {0, 0, 3}};
    const std::vector<Polygon3> faces = revealOf(tile, {0, -1, 0}, 0.25);
    ASSERT_EQ(faces.size(), 5u);
    const glm::dvec3 middle(1, 0.125, 1.5);
    for (size_t i = 0; i < 5; ++i) {
        const Polygon3& face = faces[i];
        EXPECT_GT(glm::dot(unitNormal(face), middle - centroid(face)), 0.0) << i;
    }
    EXPECT_NEAR(area(faces[0]), 2 * 0.25, 1e-12);
    EXPECT_NEAR(area(faces[1]), 3 * 0.25, 1e-12);
    EXPECT_NEAR(glm::length(unitNormal(faces[4]) - glm::dvec3(0, -1, 0)), 0.0, 1e-12);
    EXPECT_NEAR(centroid(faces[4]).y, 0.25, 1e-12);
}
