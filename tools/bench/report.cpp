// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/report.h"

#include <algorithm>
#include <cstdio>

namespace helio {

namespace {

/// What the figures of a report mean, beside milliseconds.
const char* unitOf(const std::string& figure)
{
    for (const char* plain : {"GB/s", "sweeps", "a link", "of the stream copy"})
        if (figure.ends_with(plain)) return "";
    return "ms";
}

} // namespace

double medianOf(std::vector<double> values)
{
    std::sort(values.begin(), values.end());
    const size_t half = values.size() / 2;
    return values.size() % 2 ? values[half] : (values[half - 1] + values[half]) / 2;
}

bool Report::ReportContext(const Context&)
{
    std::printf("%-42s %12s %12s %12s\n", "", "median", "min", "spread");
    return true;
}

void Report::ReportRuns(const std::vector<Run>& runs)
{
    std::map<std::string, std::vector<double>> figures;
    for (const Run& run : runs) {
        if (run.run_type != Run::RT_Iteration) continue;
        figures[""].push_back(run.GetAdjustedRealTime());
        for (const auto& [name, counter] : run.counters) figures[name].push_back(counter.value);
    }
    if (figures.empty()) return;
    const std::string& title = runs.front().run_name.function_name;
    medians_[title] = medianOf(figures[""]);
    for (const auto& [name, values] : figures) {
        const auto [least, most] = std::minmax_element(values.begin(), values.end());
        std::printf("%-42s %12.4g %12.4g %12.4g %s\n", name.empty() ? title.c_str() : ("    " + name).c_str(),
                    medianOf(values), *least, *most - *least, unitOf(name));
    }
    std::fflush(stdout);
}

void Report::Finalize()
{
    bool first = true;
    for (const Ratio& ratio : ratios_) {
        const auto slower = medians_.find(ratio.slower), faster = medians_.find(ratio.faster);
        if (slower == medians_.end() || faster == medians_.end() || faster->second <= 0.0) continue;
        if (std::exchange(first, false)) std::printf("\nRatios of medians\n");
        std::printf("%-60s %8.2f x\n", ratio.what.c_str(), slower->second / faster->second);
    }
}

} // namespace helio
