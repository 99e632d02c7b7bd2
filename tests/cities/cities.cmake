# SPDX-License-Identifier: Apache-2.0
# Over whole cities, which are not in the repository: built, run by hand.
add_executable(city_check cities/city_check.cpp cities/tree_audit.cpp cities/tree_hash.cpp)
target_link_libraries(city_check PRIVATE city_bake city_grammar city_layout city_light)
