# SPDX-License-Identifier: Apache-2.0
add_executable(grammar_test
    unit/grammar_derive_test.cpp unit/grammar_geometry_test.cpp unit/grammar_midrise_test.cpp unit/grammar_parse_test.cpp
    unit/grammar_shapes_test.cpp unit/grammar_split_test.cpp)
target_link_libraries(grammar_test PRIVATE city_grammar GTest::gtest_main)
target_compile_definitions(grammar_test PRIVATE HELIO_RULES_DIR="${CMAKE_SOURCE_DIR}/city/rules")
gtest_discover_tests(grammar_test PROPERTIES LABELS "unit")

add_executable(assets_test unit/assets_test.cpp)
target_link_libraries(assets_test PRIVATE city_assets GTest::gtest_main)
target_compile_definitions(assets_test PRIVATE HELIO_ASSETS_DIR="${CMAKE_SOURCE_DIR}/city/assets")
gtest_discover_tests(assets_test PROPERTIES LABELS "unit")
