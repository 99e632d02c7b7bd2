# SPDX-License-Identifier: Apache-2.0
add_library(screens_support STATIC
    support/image_compare.cpp
    support/image_file.cpp
    screens/ray_view.cpp)
target_link_libraries(screens_support PUBLIC city_format embree PRIVATE PNG::PNG OpenEXR::OpenEXR)

add_executable(screens_support_test
    screens/flight_test.cpp
    screens/image_compare_test.cpp
    screens/ray_view_test.cpp)
target_link_libraries(screens_support_test PRIVATE screens_support fly_core GTest::gtest_main)
gtest_discover_tests(screens_support_test PROPERTIES LABELS screens)

add_executable(window_test screens/window_test.cpp)
target_link_libraries(window_test PRIVATE engine_window GTest::gtest_main)
add_test(NAME window_test COMMAND xvfb-run -a -s "-screen 0 640x360x24 -noreset" $<TARGET_FILE:window_test>)
# xvfb-run -a looks for a free display number without a lock: one test with a display at a time.
set_tests_properties(window_test PROPERTIES LABELS screens TIMEOUT 120 RESOURCE_LOCK display)

add_library(screens_city STATIC screens/golden_check.cpp screens/test_packs.cpp screens/visibility_check.cpp)
target_link_libraries(screens_city PUBLIC screens_support engine_view PRIVATE city_bake GTest::gtest)
target_compile_definitions(screens_city PUBLIC
    HELIO_SOURCE_FOLDER="${CMAKE_SOURCE_DIR}"
    HELIO_SCREENS_PACKS="${CMAKE_CURRENT_BINARY_DIR}/screens_packs"
    HELIO_SCREENS_OUT="${CMAKE_CURRENT_BINARY_DIR}/screens_out"
    HELIO_FLY="$<TARGET_FILE:heliopolis-fly>")

add_executable(screens_pack_setup screens/pack_setup.cpp)
target_link_libraries(screens_pack_setup PRIVATE screens_city)
add_test(NAME screens_pack_setup COMMAND screens_pack_setup)
set_tests_properties(screens_pack_setup PROPERTIES LABELS screens FIXTURES_SETUP screens_packs)

add_executable(screens_test screens/fly_test.cpp screens/golden_test.cpp screens/packing_test.cpp
               screens/sun_visibility_test.cpp screens/temporal_test.cpp)
target_link_libraries(screens_test PRIVATE screens_city fly_core GTest::gtest_main)
add_dependencies(screens_test heliopolis-fly)
gtest_discover_tests(screens_test PROPERTIES LABELS screens FIXTURES_REQUIRED screens_packs TIMEOUT 120
    RESOURCE_LOCK display)

# By hand, on any pack: sun_visibility_check PACK --sun 180,45 --camera aerial --camera street
add_executable(sun_visibility_check screens/sun_visibility_check.cpp)
target_link_libraries(sun_visibility_check PRIVATE screens_support engine_view CLI11::CLI11)
target_sources(sun_visibility_check PRIVATE screens/visibility_check.cpp)
