# SPDX-License-Identifier: Apache-2.0
add_executable(hard_cases_test
    numeric/fixtures.cpp
    numeric/hard_cases_test.cpp
    numeric/hard_cities_test.cpp
    numeric/lit_scene.cpp
    numeric/pair_fixtures.cpp)
target_link_libraries(hard_cases_test PRIVATE city_grammar city_layout city_light GTest::gtest_main)
gtest_discover_tests(hard_cases_test PROPERTIES LABELS numeric)
