# SPDX-License-Identifier: Apache-2.0
add_library(helio_gpu_fixture STATIC support/gpu_fixture.cpp)
target_link_libraries(helio_gpu_fixture PUBLIC engine_graph GTest::gtest)

# Shaders of the tests alone: helio::test_shaders, "test_shaders/embedded.h".
include(${CMAKE_SOURCE_DIR}/shaders/compile/helio_shader.cmake)
set(HELIO_SHADER_NAMESPACE test_shaders)
helio_shader(gpu/shaders/layout_probe.comp)
helio_shader(gpu/shaders/scale.comp)
helio_shader(gpu/shaders/scale.comp VARIANT storage DEFINES HELIO_STORAGE_READS)
helio_shader(gpu/shaders/step.comp)
helio_shader(gpu/shaders/compare.comp)
helio_shader(gpu/shaders/triangles.vert)
helio_shader(gpu/shaders/triangles.vert VARIANT attributes DEFINES HELIO_ATTRIBUTES)
helio_shader(gpu/shaders/triangles.frag)
helio_embed_shaders(helio_test_shaders)

# Every member of every shared struct, for the C++ side of the layout test.
set(sharedHeaders records.h solve.h sun.h view.h)
list(TRANSFORM sharedHeaders PREPEND ${CMAKE_SOURCE_DIR}/shaders/shared/)
set(layoutTable ${CMAKE_CURRENT_BINARY_DIR}/layout_table/layout_table.inc)
add_custom_command(
    OUTPUT ${layoutTable}
    COMMAND ${CMAKE_COMMAND} "-DHEADERS=${sharedHeaders}" -DOUTPUT=${layoutTable} -P ${CMAKE_CURRENT_SOURCE_DIR}/gpu/layout_table.cmake
    DEPENDS ${sharedHeaders} ${CMAKE_CURRENT_SOURCE_DIR}/gpu/layout_table.cmake
    VERBATIM)

add_executable(gpu_engine_test ${layoutTable} gpu/compute_test.cpp gpu/context_test.cpp gpu/graph_execute_test.cpp
               gpu/layout_offsets_test.cpp gpu/raster_test.cpp gpu/transfer_test.cpp gpu/validation_test.cpp)
target_link_libraries(gpu_engine_test PRIVATE helio_gpu_fixture helio_test_shaders helio_spirv GTest::gtest_main)
target_include_directories(gpu_engine_test PRIVATE ${CMAKE_CURRENT_BINARY_DIR}/layout_table)
target_compile_definitions(gpu_engine_test PRIVATE HELIO_SHADER_SOURCES="${CMAKE_SOURCE_DIR}/shaders/shared")
gtest_discover_tests(gpu_engine_test PROPERTIES LABELS "gpu")
