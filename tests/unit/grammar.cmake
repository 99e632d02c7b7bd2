# SPDX-License-Identifier: Apache-2.0
add_executable(grammar_test
    unit/grammar_derive_test.cpp unit/grammar_geometry_test.cpp unit/grammar_midrise_test.cpp unit/grammar_parse_test.cpp
    unit/grammar_shapes_test.cpp unit/grammar_split_test.cpp
    unit/grammar_component_test.cpp unit/grammar_roof_test.cpp unit/grammar_setback_test.cpp
    unit/grammar_errors_test.cpp unit/grammar_explain_test.cpp unit/grammar_import_test.cpp)
target_sources(grammar_test PRIVATE
    unit/grammar_covered_test.cpp unit/grammar_faces_test.cpp unit/grammar_occlusion_test.cpp unit/grammar_placement_test.cpp
    unit/grammar_progress_test.cpp unit/grammar_reference_rules_test.cpp unit/grammar_scatter_test.cpp unit/grammar_shaping_test.cpp)
target_link_libraries(grammar_test PRIVATE city_grammar GTest::gtest_main)
target_compile_definitions(grammar_test PRIVATE HELIO_RULES_DIR="${CMAKE_SOURCE_DIR}/city/rules"
    HELIO_TEST_DATA_DIR="${CMAKE_SOURCE_DIR}/tests/data")
gtest_discover_tests(grammar_test PROPERTIES LABELS "unit")

add_executable(assets_test unit/assets_test.cpp)
target_link_libraries(assets_test PRIVATE city_assets GTest::gtest_main)
target_compile_definitions(assets_test PRIVATE HELIO_ASSETS_DIR="${CMAKE_SOURCE_DIR}/city/assets")
gtest_discover_tests(assets_test PROPERTIES LABELS "unit")

add_executable(rules_test unit/rules_architecture_test.cpp unit/grammar_solid_check.cpp)
target_link_libraries(rules_test PRIVATE city_bake GTest::gtest_main)
target_compile_definitions(rules_test PRIVATE HELIO_RULES_DIR="${CMAKE_SOURCE_DIR}/city/rules"
    HELIO_ASSETS_DIR="${CMAKE_SOURCE_DIR}/city/assets")
gtest_discover_tests(rules_test PROPERTIES LABELS "unit")
