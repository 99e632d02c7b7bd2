# SPDX-License-Identifier: Apache-2.0
add_executable(light_test
    numeric/fixtures.cpp
    numeric/form_factor_test.cpp)
target_link_libraries(light_test PRIVATE city_light GTest::gtest_main)
gtest_discover_tests(light_test PROPERTIES LABELS numeric)
