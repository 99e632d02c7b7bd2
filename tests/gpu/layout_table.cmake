# SPDX-License-Identifier: Apache-2.0
# Run at build time: cmake -DHEADERS=a.h;b.h -DOUTPUT=table.inc -P layout_table.cmake
# Writes one line HELIO_LAYOUT(Struct, HELIO_AT(member), ...) for each struct of the shared headers, so that the layout test
# asks the C++ compiler for every member that there is.
set(table "")
foreach(header IN LISTS HEADERS)
    file(STRINGS ${header} lines)
    set(struct "")
    foreach(line IN LISTS lines)
        if(line MATCHES "^struct ([A-Za-z0-9_]+) {")
            set(struct ${CMAKE_MATCH_1})
            string(APPEND table "HELIO_LAYOUT(${struct}")
        elseif(struct AND line MATCHES "^};")
            string(APPEND table "),\n")
            set(struct "")
        elseif(struct AND line MATCHES "^ +[a-z0-9A-Z]+ ([A-Za-z0-9_]+)(\\[[0-9]+\\])?;")
            string(APPEND table ", HELIO_AT(${CMAKE_MATCH_1})")
        endif()
    endforeach()
endforeach()
file(WRITE ${OUTPUT} "${table}")
