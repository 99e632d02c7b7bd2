// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <algorithm>
#include <cstdlib>
#include <string>
#include <sys/wait.h>

#include "city/base/file.h"
#include "tests/unit/pack_temp_folder.h"

namespace helio::test {

struct RunResult
{
    int exitCode = -1; ///< or 128 + the signal that ended the program
    std::string out, err;

    size_t errorLines() const { return size_t(std::count(err.begin(), err.end(), '\n')); }
};

/// Runs a built program through the shell with `folder` as working folder and catches what it prints.
inline RunResult runProgram(const std::string& program, const std::string& arguments,
                            const std::filesystem::path& folder)
{
    const TempFolder output;
    const std::string command = "cd '" + folder.string() + "' && '" + program + "' " + arguments + " >'" +
                                (output / "out").string() + "' 2>'" + (output / "err").string() + "' </dev/null";
    const int status = std::system(command.c_str());
    RunResult result;
    result.exitCode = WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
    for (auto [name, text] : {std::pair{"out", &result.out}, {"err", &result.err}})
        if (Result<std::string> read = readTextFile(output / name)) *text = *read;
    return result;
}

} // namespace helio::test
