# SPDX-License-Identifier: Apache-2.0
add_executable(cli_test
    unit/cli_bake_test.cpp unit/cli_city_test.cpp unit/cli_factors_test.cpp unit/cli_hard_cases_test.cpp unit/cli_reference_test.cpp
    numeric/factor_rows.cpp numeric/pair_fixtures.cpp numeric/text_table.cpp)
target_link_libraries(cli_test PRIVATE city_pack nlohmann_json::nlohmann_json GTest::gtest_main)
target_compile_definitions(cli_test PRIVATE
    HELIO_BAKE="$<TARGET_FILE:heliopolis-bake>"
    HELIO_ASSETS="${CMAKE_SOURCE_DIR}/city/assets"
    HELIO_TEST_DATA_DIR="${CMAKE_SOURCE_DIR}/tests/data"
    HELIO_SCENES="${CMAKE_SOURCE_DIR}/tests/data/scenes")
add_dependencies(cli_test heliopolis-bake)
gtest_discover_tests(cli_test PROPERTIES LABELS "cli")
