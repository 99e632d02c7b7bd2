// SPDX-License-Identifier: Apache-2.0
#include "city/model/plane_groups.h"

#include <gtest/gtest.h>

#include <cmath>
#include <glm/geometric.hpp>

#include "city/base/hash.h"

using namespace helio;

namespace {

/// The definition, pair by pair: each item that is still free takes all later free ones that lie in its plane.
std::vector<std::vector<u32>> groupPairByPair(const std::vector<PlaneItem>& items)
{
    std::vector<std::vector<u32>> groups;
    std::vector<bool> taken(items.size(), false);
    for (u32 i = 0; i < items.size(); ++i) {
        if (taken[i]) continue;
        groups.push_back({i});
        for (u32 j = i + 1; j < items.size() && !items[i].alone; ++j) {
            if (taken[j] || items[j].alone || glm::dot(items[i].normal, items[j].normal) <= 1.0 - 1e-5 ||
                std::abs(glm::dot(items[i].normal, items[j].point - items[i].point)) >= 2e-3)
                continue;
            taken[j] = true;
            groups.back().push_back(j);
        }
    }
    return groups;
}

TEST(PlaneGroups, AgreeWithTheDefinitionPairByPair)
{
    Random random(5);
    for (int round = 0; round < 50; ++round) {
        // Few directions and heights, each shaken by about the tolerance, far from the origin, so that all cases occur.
        std::vector<PlaneItem> items;
        for (int i = 0; i < 300; ++i) {
            glm::dvec3 normal(0.0);
            normal[int(3 * random.uniform())] = random.uniform() < 0.5 ? 1.0 : -1.0;
            for (int k = 0; k < 3; ++k) normal[k] += 0.004 * (random.uniform() - 0.5);
            glm::dvec3 point(1000.0, -2000.0, 0.0);
            for (int k = 0; k < 3; ++k)
                point[k] += std::floor(3.0 * random.uniform()) + 0.004 * (random.uniform() - 0.5);
            items.push_back({glm::normalize(normal), point, random.uniform() < 0.1});
        }
        const std::vector<std::vector<u32>> groups = groupByPlane(items);
        ASSERT_EQ(groups, groupPairByPair(items)) << round;
        ASSERT_LT(groups.size(), items.size()) << "nothing was grouped";
    }
}

TEST(PlaneGroups, OfNothingAreNone)
{
    EXPECT_TRUE(groupByPlane({}).empty());
}

} // namespace
