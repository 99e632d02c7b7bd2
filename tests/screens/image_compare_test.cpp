// SPDX-License-Identifier: Apache-2.0
#include "tests/support/image_compare.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace helio {
namespace {

TEST(ImageCompare, CountsPixelsOverTheLimitAndTheMean)
{
    const TestImage golden = makeTestImage(10, 10, 100);
    TestImage actual = golden;
    actual.at(3, 7)[1] = 106;
    actual.at(4, 7)[0] = 105; // not more than the limit
    const Difference difference = compareImages(actual, golden, 5);
    EXPECT_EQ(difference.pixelsOver, 1u);
    EXPECT_DOUBLE_EQ(difference.share, 0.01);
    EXPECT_DOUBLE_EQ(difference.worst, 6);
    EXPECT_EQ(difference.worstX, 3u);
    EXPECT_EQ(difference.worstY, 7u);
    EXPECT_DOUBLE_EQ(difference.mean, 11.0 / 300);
    EXPECT_TRUE(accepts({5, 0.01, 0.04}, difference));
    EXPECT_FALSE(accepts({5, 0.009, 0.04}, difference));
    EXPECT_FALSE(accepts({5, 0.01, 0.03}, difference));
}

TEST(ImageCompare, AnotherSizeOrNotANumberIsNeverAccepted)
{
    constexpr Tolerance kAnything{1e9, 1.0, 1e9};
    const TestImage golden = makeTestImage(4, 4, 1);
    EXPECT_FALSE(accepts(kAnything, compareImages(makeTestImage(4, 5, 1), golden, 1e9)));
    TestImage broken = golden;
    broken.at(0, 0)[2] = std::numeric_limits<float>::quiet_NaN();
    EXPECT_FALSE(accepts(kAnything, compareImages(broken, golden, 1e9)));
}

TEST(ImageCompare, FilesKeepTheirPictures)
{
    TestImage image = makeTestImage(5, 3, 0);
    for (size_t i = 0; i < image.rgb.size(); ++i) image.rgb[i] = float(i * 5); // exact in a byte and in a half float
    for (const char* name : {"kept.png", "kept.exr"}) {
        const std::filesystem::path path = std::filesystem::path(testing::TempDir()) / name;
        ASSERT_TRUE(writeTestImage(path, image).ok());
        const Result<TestImage> read = readTestImage(path);
        ASSERT_TRUE(read.ok()) << read.error().message;
        EXPECT_EQ(read->width, 5u);
        EXPECT_EQ(read->rgb, image.rgb) << name;
    }
    EXPECT_FALSE(readTestImage("no such picture.png").ok());
    EXPECT_FALSE(readTestImage("no such picture.exr").ok());
}

} // namespace
} // namespace helio
