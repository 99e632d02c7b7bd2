# SPDX-License-Identifier: Apache-2.0
add_executable(geometry_roof_test
    unit/geometry_roof_property_test.cpp
    unit/geometry_roof_test.cpp
    unit/geometry_skeleton_test.cpp)
target_link_libraries(geometry_roof_test PRIVATE city_geometry GTest::gtest_main)
gtest_discover_tests(geometry_roof_test PROPERTIES LABELS unit)
