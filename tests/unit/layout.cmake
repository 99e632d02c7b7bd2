# SPDX-License-Identifier: Apache-2.0
add_executable(layout_test
    ${CMAKE_CURRENT_LIST_DIR}/layout_builtin_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_cityjson_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_dirty_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_geojson_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_ground_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_import_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_projection_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_repair_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_surfaces_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_validity_test.cpp
    ${CMAKE_CURRENT_LIST_DIR}/layout_walls_test.cpp)
target_link_libraries(layout_test PRIVATE city_layout GTest::gtest_main)
gtest_discover_tests(layout_test PROPERTIES LABELS "unit")
