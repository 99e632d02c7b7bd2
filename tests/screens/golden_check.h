// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <gtest/gtest.h>
#include <string>

#include "tests/support/image_compare.h"

namespace helio {

/// Where goldens are read from and where results go.
struct GoldenFolders
{
    std::filesystem::path goldens; ///< of this driver and version
    std::filesystem::path out;     ///< made when missing
};

/// Folder name of a driver: its name and version in lower case, everything but letters, digits and dots as one '_'.
std::string driverFolder(const std::string& driver);

/// Compares a picture with the golden of this file name (.png or .exr). Whatever the outcome, writes NAME (what was
/// rendered), NAME.heat.png and NAME.txt (numbers and limits) to the out folder. A missing golden fails; the message
/// says how to make one.
testing::AssertionResult matchesGolden(const GoldenFolders& folders, const std::string& name, const TestImage& actual,
                                       const Tolerance& tolerance);

} // namespace helio
