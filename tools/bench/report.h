// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <span>

#include "tools/bench/case_list.h"

namespace helio {

double medianOf(std::vector<double> values);

/// Prints median, minimum and spread (largest - smallest) over the repetitions of each case and of its figures, in the
/// order in which cases end; at the end the ratios.
class Report : public benchmark::BenchmarkReporter
{
public:
    explicit Report(const std::vector<Ratio>& ratios) : ratios_(ratios) {}
    bool ReportContext(const Context&) override;
    void ReportRuns(const std::vector<Run>& runs) override;
    void Finalize() override;

private:
    const std::vector<Ratio>& ratios_;
    std::map<std::string, double> medians_;
};

} // namespace helio
