// SPDX-License-Identifier: Apache-2.0
#include "engine/view/camera_path.h"

#include <gtest/gtest.h>

#include <glm/geometric.hpp>

namespace helio {

namespace {

TEST(CameraPath, ReadsKeysAndComments)
{
    const auto path = parseCameraPath("# a street\n0 1,2,3,4,5,6\n\n2.5 -1,2e1,3,4,5,6,60 # wider\r\n");
    ASSERT_TRUE(path.ok()) << path.error().message;
    ASSERT_EQ(path->size(), 2u);
    EXPECT_EQ((*path)[1].seconds, 2.5);
    EXPECT_EQ((*path)[1].camera.eye, glm::dvec3(-1, 20, 3));
    EXPECT_EQ((*path)[1].camera.fovDegrees, 60.0);
    EXPECT_EQ((*path)[0].camera.fovDegrees, Camera().fovDegrees);
}

TEST(CameraPath, NamesTheLineThatIsWrong)
{
    const std::pair<const char*, const char*> cases[] = {
        {"0 1,2,3,4,5,6\n1 1,2,3\n", "line 2: expected"},
        {"0 1,2,3,4,5,6\n\n0 2,2,3,4,5,6\n", "line 3: time"},
        {"-1 1,2,3,4,5,6\n1 1,2,3,4,5,6\n", "line 1: time"},
        {"0 1,2,3,1,2,3\n1 1,2,3,4,5,6\n", "line 1: the eye"},
        {"0 1,2,3,4,5,6,200\n1 1,2,3,4,5,6\n", "line 1: field of view"},
        {"0 1,2,3,4,5,6 7\n1 1,2,3,4,5,6\n", "line 1: ' 7'"},
        {"0 nan,2,3,4,5,6\n1 1,2,3,4,5,6\n", "line 1: a number"},
        {"0 1,2,3,4,5,6\n", "1 keys"},
        {"", "0 keys"},
    };
    for (const auto& [text, what] : cases) {
        const auto path = parseCameraPath(text);
        ASSERT_FALSE(path.ok()) << text;
        EXPECT_NE(path.error().message.find(what), std::string::npos) << path.error().message;
    }
}

TEST(CameraPath, GoesThroughEveryKeyWithoutAJerk)
{
    const auto path = parseCameraPath("1 0,0,0,0,9,0,40\n2 10,0,0,10,9,0,50\n4 10,20,0,0,9,0,40\n5 0,20,5,9,9,0,45\n");
    ASSERT_TRUE(path.ok());
    for (const PathKey& key : *path) {
        const Camera camera = cameraAt(*path, key.seconds);
        EXPECT_NEAR(glm::distance(camera.eye, key.camera.eye), 0.0, 1e-12);
        EXPECT_NEAR(camera.fovDegrees, key.camera.fovDegrees, 1e-12);
    }
    EXPECT_EQ(cameraAt(*path, 0.0).eye, (*path)[0].camera.eye);
    EXPECT_EQ(cameraAt(*path, 9.0).eye, (*path)[3].camera.eye);
    // The speed at an inner key is the same from both sides, and that from the key before to the key after.
    constexpr double kStep = 1e-5;
    for (const double t : {2.0, 4.0}) {
        const glm::dvec3 at = cameraAt(*path, t).eye;
        const glm::dvec3 in = (at - cameraAt(*path, t - kStep).eye) / kStep,
                         out = (cameraAt(*path, t + kStep).eye - at) / kStep;
        EXPECT_NEAR(glm::distance(in, out), 0.0, 1e-2) << t;
    }
    const glm::dvec3 expected = ((*path)[2].camera.eye - (*path)[0].camera.eye) / 3.0;
    const glm::dvec3 speed = (cameraAt(*path, 2.0 + kStep).eye - cameraAt(*path, 2.0 - kStep).eye) / (2.0 * kStep);
    EXPECT_NEAR(glm::distance(speed, expected), 0.0, 1e-3);
}

} // namespace

} // namespace helio
