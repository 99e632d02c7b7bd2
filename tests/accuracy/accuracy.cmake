# SPDX-License-Identifier: Apache-2.0
# The two tools, end to end, against the reference path tracer.
add_executable(accuracy_test accuracy/accuracy_test.cpp accuracy/csv_table.cpp)
target_compile_definitions(accuracy_test PRIVATE
    HELIO_BIN_DIR="${CMAKE_RUNTIME_OUTPUT_DIRECTORY}" HELIO_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/data")
target_link_libraries(accuracy_test PRIVATE city_light GTest::gtest_main)
add_dependencies(accuracy_test heliopolis-bake heliopolis-render)
gtest_discover_tests(accuracy_test PROPERTIES LABELS gpu)
