# SPDX-License-Identifier: Apache-2.0
add_library(stage_test_support STATIC support/smooth_twin.cpp support/stage_twins.cpp support/tile_builder.cpp
            support/wall_builder.cpp)
target_link_libraries(stage_test_support PUBLIC city_format)

add_executable(gpu_stages_test
    gpu/gather_test.cpp
    gpu/histogram_test.cpp
    gpu/renderer_test.cpp
    gpu/sky_energy_test.cpp
    gpu/smooth_light_test.cpp
    gpu/sun_energy_test.cpp
    gpu/sun_raster_test.cpp
    support/unpack_links.cpp)
target_link_libraries(gpu_stages_test PRIVATE helio_gpu_fixture stage_test_support engine_view GTest::gtest_main)
gtest_discover_tests(gpu_stages_test PROPERTIES LABELS gpu)

# The solvers of engine and baker and their twin, on the same tree and links.
add_executable(solver_agreement_test gpu/solver_agreement_test.cpp numeric/fixtures.cpp)
target_link_libraries(solver_agreement_test PRIVATE helio_gpu_fixture stage_test_support engine_stages city_light
                      GTest::gtest_main)
gtest_discover_tests(solver_agreement_test PROPERTIES LABELS gpu)

# What the stages decide without a device.
add_executable(engine_unit_test unit/engine_solver_test.cpp unit/engine_tables_test.cpp unit/engine_view_test.cpp
               unit/camera_path_test.cpp unit/facing_test.cpp unit/link_packing_test.cpp unit/patch_values_test.cpp unit/smooth_mesh_test.cpp support/unpack_links.cpp)
target_link_libraries(engine_unit_test PRIVATE stage_test_support engine_view GTest::gtest_main)
gtest_discover_tests(engine_unit_test PROPERTIES LABELS unit)
