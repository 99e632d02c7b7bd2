# SPDX-License-Identifier: Apache-2.0
add_executable(graph_test unit/graph_barriers_test.cpp unit/graph_culling_test.cpp unit/graph_device_test.cpp
               unit/graph_misuse_test.cpp unit/graph_shader_test.cpp)
target_link_libraries(graph_test PRIVATE engine_graph helio_glsl helio_spirv GTest::gtest_main)
gtest_discover_tests(graph_test PROPERTIES LABELS "unit")
