# SPDX-License-Identifier: Apache-2.0
add_executable(light_test
    cities/tree_audit.cpp
    numeric/compact_links_test.cpp
    numeric/covered_test.cpp
    numeric/factor_rows.cpp
    numeric/factors_occluded_test.cpp
    numeric/factors_test.cpp
    numeric/fixtures.cpp
    numeric/form_factor_test.cpp
    numeric/links_test.cpp
    numeric/occluders_test.cpp
    numeric/pair_fixtures.cpp
    numeric/paper_links_test.cpp
    numeric/path_tracer_test.cpp
    numeric/scenes_test.cpp
    numeric/predicted_error_test.cpp
    numeric/solver_test.cpp
    numeric/text_table.cpp
    numeric/visibility_test.cpp
    accuracy/csv_table.cpp)
target_compile_definitions(light_test PRIVATE HELIO_TEST_DATA="${CMAKE_CURRENT_SOURCE_DIR}/data")
target_link_libraries(light_test PRIVATE city_light city_layout city_pack GTest::gtest_main)
gtest_discover_tests(light_test PROPERTIES LABELS numeric)
