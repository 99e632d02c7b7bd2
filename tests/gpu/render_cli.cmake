# SPDX-License-Identifier: Apache-2.0
add_executable(render_cli_test gpu/render_cli_test.cpp support/image_file.cpp)
target_link_libraries(render_cli_test PRIVATE city_format nlohmann_json::nlohmann_json OpenEXR::OpenEXR PNG::PNG
                      GTest::gtest_main)
target_compile_definitions(render_cli_test PRIVATE
    HELIO_BAKE="$<TARGET_FILE:heliopolis-bake>"
    HELIO_RENDER="$<TARGET_FILE:heliopolis-render>"
    HELIO_BENCH="$<TARGET_FILE:heliopolis-bench>"
    HELIO_SCENES="${CMAKE_SOURCE_DIR}/tests/data/scenes")
add_dependencies(render_cli_test heliopolis-bake heliopolis-render heliopolis-bench)
gtest_discover_tests(render_cli_test PROPERTIES LABELS "cli")
