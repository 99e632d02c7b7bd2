# SPDX-License-Identifier: Apache-2.0
add_executable(solutions_test
    numeric/enclosures_test.cpp
    numeric/exact_light.cpp
    numeric/fixtures.cpp
    numeric/solution_scenes.cpp
    numeric/solutions_test.cpp
    numeric/text_table.cpp)
target_compile_definitions(solutions_test PRIVATE HELIO_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/data")
target_link_libraries(solutions_test PRIVATE city_light GTest::gtest_main)
gtest_discover_tests(solutions_test PROPERTIES LABELS numeric)
