# SPDX-License-Identifier: Apache-2.0

# The namespace inside helio and the folder of the header embedded.h; set another before the calls below for another library.
set(HELIO_SHADER_NAMESPACE shaders)

# helio_shader(FILE [VARIANT name] [DEFINES A=1 ...]): compiles one shader of this folder.
function(helio_shader file)
    cmake_parse_arguments(PARSE_ARGV 1 arg "" "VARIANT" "DEFINES")
    if(arg_UNPARSED_ARGUMENTS)
        message(FATAL_ERROR "helio_shader(${file}): do not know what to do with '${arg_UNPARSED_ARGUMENTS}'")
    endif()
    cmake_path(GET file STEM stem)
    cmake_path(GET file EXTENSION LAST_ONLY stage)
    string(SUBSTRING "${stage}" 1 -1 stage)
    set(words ${stem})
    if(arg_VARIANT)
        string(APPEND words _${arg_VARIANT})
    endif()
    string(APPEND words _${stage})
    string(REPLACE "_" ";" parts "${words}")
    set(symbol k)
    foreach(part IN LISTS parts)
        string(SUBSTRING "${part}" 0 1 first)
        string(SUBSTRING "${part}" 1 -1 rest)
        string(TOUPPER "${first}" first)
        string(APPEND symbol ${first}${rest})
    endforeach()

    set(source ${CMAKE_CURRENT_SOURCE_DIR}/${file})
    set(output ${CMAKE_CURRENT_BINARY_DIR}/${words}.spv.cpp)
    list(TRANSFORM arg_DEFINES PREPEND -D)
    add_custom_command(
        OUTPUT ${output}
        COMMAND helio_shader_compile ${arg_DEFINES} -I${CMAKE_SOURCE_DIR} -I${CMAKE_CURRENT_SOURCE_DIR} -n ${HELIO_SHADER_NAMESPACE}
                -s ${symbol} -d ${output}.d -o ${output} ${source}
        DEPENDS helio_shader_compile ${source}
        DEPFILE ${output}.d
        COMMENT "Compiling shader ${words}"
        VERBATIM)
    set_property(DIRECTORY APPEND PROPERTY HELIO_SHADER_OUTPUTS ${output})
    set_property(DIRECTORY APPEND PROPERTY HELIO_SHADER_SYMBOLS ${symbol})
endfunction()

# helio_embed_shaders(TARGET): the library of all shaders of this folder, with the header "<namespace>/embedded.h".
function(helio_embed_shaders target)
    get_directory_property(outputs HELIO_SHADER_OUTPUTS)
    get_directory_property(symbols HELIO_SHADER_SYMBOLS)
    set(declarations "")
    set(addresses "")
    foreach(symbol IN LISTS symbols)
        string(APPEND declarations "extern const ShaderCode ${symbol};\n")
        string(APPEND addresses "&${symbol}, ")
    endforeach()
    set(generated ${CMAKE_CURRENT_BINARY_DIR}/generated_${HELIO_SHADER_NAMESPACE})
    file(CONFIGURE OUTPUT ${generated}/${HELIO_SHADER_NAMESPACE}/embedded.h @ONLY CONTENT
[[// Generated from the list of shaders.
#pragma once
#include "shaders/shader_code.h"

namespace helio::@HELIO_SHADER_NAMESPACE@ {

@declarations@
/// All of them, in the order of the list.
std::span<const ShaderCode* const> all();

} // namespace helio::@HELIO_SHADER_NAMESPACE@
]])
    file(CONFIGURE OUTPUT ${generated}/all_shaders.cpp @ONLY CONTENT
[[// Generated from the list of shaders.
#include "@HELIO_SHADER_NAMESPACE@/embedded.h"

namespace helio::@HELIO_SHADER_NAMESPACE@ {

std::span<const ShaderCode* const> all()
{
    static constexpr const ShaderCode* kAll[] = {@addresses@};
    return kAll;
}

} // namespace helio::@HELIO_SHADER_NAMESPACE@
]])
    add_library(${target} STATIC ${outputs} ${generated}/all_shaders.cpp)
    target_include_directories(${target} PUBLIC ${generated})
    target_link_libraries(${target} PUBLIC helio_options)
endfunction()
