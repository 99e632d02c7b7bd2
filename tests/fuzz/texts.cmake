# SPDX-License-Identifier: Apache-2.0
# Each target takes all files of its corpus, the regression inputs among them, then mutations of them.
set(rules_corpus ${CMAKE_SOURCE_DIR}/city/rules ${CMAKE_CURRENT_SOURCE_DIR}/data/rules)
foreach(target IN ITEMS rules import)
    add_executable(${target}_fuzz fuzz/${target}_fuzz.cpp fuzz/text_main.cpp fuzz/text_mutator.cpp)
    add_test(NAME ${target}_fuzz.BoundedMutations
        COMMAND ${target}_fuzz --count 3000 --keep ${CMAKE_CURRENT_BINARY_DIR}
            ${CMAKE_CURRENT_SOURCE_DIR}/data/fuzz/${target} ${${target}_corpus})
    set_tests_properties(${target}_fuzz.BoundedMutations PROPERTIES LABELS "fuzz" TIMEOUT 300)
endforeach()
target_link_libraries(rules_fuzz PRIVATE city_grammar)
target_link_libraries(import_fuzz PRIVATE city_layout)
