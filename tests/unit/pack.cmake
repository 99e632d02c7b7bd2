# SPDX-License-Identifier: Apache-2.0
add_executable(pack_test
    unit/compact_links_test.cpp unit/pack_content_test.cpp unit/pack_export_test.cpp unit/pack_format_test.cpp unit/pack_reveal_test.cpp
    unit/pack_validate_test.cpp
    unit/pack_writer_test.cpp)
target_link_libraries(pack_test PRIVATE city_pack GTest::gtest_main)
gtest_discover_tests(pack_test PROPERTIES LABELS "unit")
