# SPDX-License-Identifier: Apache-2.0
add_executable(sky_test
    numeric/sky_cells_test.cpp
    numeric/fixtures.cpp
    numeric/sky_links_test.cpp
    numeric/sky_test.cpp
    unit/solar_position_test.cpp)
target_compile_definitions(sky_test PRIVATE HELIO_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/data")
target_link_libraries(sky_test PRIVATE city_light city_layout GTest::gtest_main)
gtest_discover_tests(sky_test PROPERTIES LABELS numeric)
