// SPDX-License-Identifier: Apache-2.0
#include "city/model/materials.h"

#include <gtest/gtest.h>

namespace helio {
namespace {

TEST(Materials, LieInTheRangeOfTheirSource)
{
    for (const Material& material : materials()) {
        EXPECT_GE(material.rho.a, material.solarLow) << material.name;
        EXPECT_LE(material.rho.a, material.solarHigh) << material.name;
        EXPECT_FALSE(material.source.empty()) << material.name;
        for (int k = 0; k < 4; ++k) {
            EXPECT_GT(material.rho[k], 0.0) << material.name;
            EXPECT_LE(material.rho[k], 0.95) << material.name;
            EXPECT_GE(material.emission[k], 0.0) << material.name;
        }
    }
}

TEST(Materials, AreFoundByNameAndNoOther)
{
    ASSERT_GT(materials().size(), 30u);
    for (const Material& material : materials()) EXPECT_EQ(materialNamed(material.name), &material) << material.name;
    EXPECT_EQ(materialNamed("unobtainium"), nullptr);
    EXPECT_EQ(materialNamed(""), nullptr);
    EXPECT_FALSE(findMaterial("zinc ").has_value());
}

TEST(Materials, EmittersAgreeWithTheirLuminousExitance)
{
    // Rec.709 luminance of r, g, b times 105 lm/W is the exitance that the table states.
    const std::pair<const char*, double> kExitance[] = {{"lit_window", 120.0}, {"lit_shop", 400.0}, {"lamp", 31416.0}};
    for (const auto& [name, exitance] : kExitance) {
        const Material* material = materialNamed(name);
        ASSERT_NE(material, nullptr) << name;
        const glm::dvec4& e = material->emission;
        EXPECT_NEAR(105.0 * (0.2126 * e.r + 0.7152 * e.g + 0.0722 * e.b), exitance, 0.002 * exitance) << name;
        EXPECT_NEAR(300.0 * e.a, exitance, 1e-6 * exitance) << name;
    }
}

} // namespace
} // namespace helio
