# SPDX-License-Identifier: Apache-2.0
# Run at every build: cmake -DSOURCE=... -DOUTPUT=commit.h -P commit.cmake. Writes the commit that is built, if it changed.
execute_process(COMMAND git -C ${SOURCE} describe --always --dirty OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE
                ERROR_QUIET RESULT_VARIABLE failed)
if(failed)
    set(commit "unknown")
endif()
file(CONFIGURE OUTPUT ${OUTPUT} CONTENT
[[// Generated at build time.
#pragma once
namespace helio {
inline constexpr const char* kCommit = "@commit@";
}
]] @ONLY)
