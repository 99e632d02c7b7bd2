# SPDX-License-Identifier: Apache-2.0
# The window is a library of its own, so that programs without one link no window system.
add_library(engine_window STATIC ${CMAKE_CURRENT_LIST_DIR}/window.cpp)
target_link_libraries(engine_window PUBLIC engine_graph PRIVATE glfw)
