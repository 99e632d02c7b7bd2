# SPDX-License-Identifier: Apache-2.0
add_executable(pack_fuzz fuzz/pack_fuzz.cpp fuzz/fuzz_main.cpp)
target_link_libraries(pack_fuzz PRIVATE city_pack)
add_test(NAME PackFuzz.BoundedMutations COMMAND pack_fuzz)
set_tests_properties(PackFuzz.BoundedMutations PROPERTIES LABELS "fuzz" TIMEOUT 120)
