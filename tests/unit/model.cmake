# SPDX-License-Identifier: Apache-2.0
add_executable(model_test
    unit/base_test.cpp
    unit/build_nodes_test.cpp
    unit/guillotine_test.cpp
    unit/join_polygons_test.cpp
    unit/materials_test.cpp
    unit/patch_cells_test.cpp
    unit/plane_groups_test.cpp
    unit/polygon_test.cpp)
target_link_libraries(model_test PRIVATE city_model GTest::gtest_main)
gtest_discover_tests(model_test PROPERTIES LABELS unit)
