// SPDX-License-Identifier: Apache-2.0
#include "tests/screens/golden_check.h"

#include <cctype>

#include "city/base/file.h"

namespace helio {

std::string driverFolder(const std::string& driver)
{
    std::string name;
    for (const char c : driver) {
        const bool keep = std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '.';
        if (keep)
            name += char(std::tolower(static_cast<unsigned char>(c)));
        else if (!name.empty() && name.back() != '_')
            name += '_';
    }
    while (!name.empty() && name.back() == '_') name.pop_back();
    return name;
}

testing::AssertionResult matchesGolden(const GoldenFolders& folders, const std::string& name, const TestImage& actual,
                                       const Tolerance& tolerance)
{
    std::error_code failure;
    std::filesystem::create_directories(folders.out, failure);
    const std::filesystem::path shown = folders.out / name;
    if (Status written = writeTestImage(shown, actual); !written)
        return testing::AssertionFailure() << written.error().message;
    const std::filesystem::path goldenPath = folders.goldens / name;
    const Result<TestImage> golden = readTestImage(goldenPath);
    if (!golden)
        return testing::AssertionFailure()
               << golden.error().message << "\nthere is no golden for this picture: look at " << shown.string()
               << ", and if it is right run tests/screens/update_goldens " << name;

    // What was written is what is compared: both sides went through the same rounding.
    const Result<TestImage> rounded = readTestImage(shown);
    if (!rounded) return testing::AssertionFailure() << rounded.error().message;
    const Difference difference = compareImages(*rounded, *golden, tolerance.maxDifference);
    const std::string numbers = describe(difference, tolerance);
    const std::filesystem::path heat = folders.out / (name + ".heat.png");
    if (Status written = writeTestImage(heat, heatMap(*rounded, *golden, tolerance.maxDifference)); !written)
        return testing::AssertionFailure() << written.error().message;
    if (Status written = writeTextAtomically(folders.out / (name + ".txt"), numbers + "\n"); !written)
        return testing::AssertionFailure() << written.error().message;
    if (accepts(tolerance, difference)) return testing::AssertionSuccess() << numbers;
    return testing::AssertionFailure() << name << " differs from its golden\n"
                                       << numbers << "\nrendered: " << shown.string()
                                       << "\ngolden: " << goldenPath.string() << "\nheat map: " << heat.string();
}

} // namespace helio
