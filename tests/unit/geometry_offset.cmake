# SPDX-License-Identifier: Apache-2.0
add_executable(geometry_offset_test unit/geometry_offset_test.cpp unit/grammar_primitives_test.cpp)
target_link_libraries(geometry_offset_test PRIVATE city_geometry city_grammar GTest::gtest_main)
gtest_discover_tests(geometry_offset_test PROPERTIES LABELS "unit")
