# SPDX-License-Identifier: Apache-2.0
add_executable(grammar_test
    unit/grammar_geometry_test.cpp unit/grammar_parse_test.cpp unit/grammar_split_test.cpp)
target_link_libraries(grammar_test PRIVATE city_grammar GTest::gtest_main)
gtest_discover_tests(grammar_test PROPERTIES LABELS "unit")
