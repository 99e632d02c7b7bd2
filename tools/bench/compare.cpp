// SPDX-License-Identifier: Apache-2.0
#include "tools/bench/compare.h"

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>

#include "tools/bench/report.h"

namespace helio {

namespace {

struct RunFile
{
    std::string device, commit;
    std::map<std::string, std::vector<double>> times;
};

Result<RunFile> readRun(const std::string& path)
{
    std::ifstream file(path);
    if (!file) return Error{concat(path, ": cannot be read")};
    const nlohmann::json json = nlohmann::json::parse(file, nullptr, false);
    if (json.is_discarded() || !json.is_object() || !json.contains("benchmarks") || !json["benchmarks"].is_array())
        return Error{concat(path, ": is not a file of heliopolis-bench --json")};
    RunFile run;
    if (const auto context = json.find("context"); context != json.end() && context->is_object()) {
        run.device = context->value("device", "");
        run.commit = context->value("commit", "");
    }
    for (const nlohmann::json& item : json["benchmarks"]) {
        if (!item.is_object() || item.value("run_type", "") != "iteration") continue;
        const auto name = item.find("run_name"), time = item.find("real_time");
        if (name == item.end() || time == item.end() || !name->is_string() || !time->is_number()) continue;
        const std::string title = name->get<std::string>();
        run.times[title.substr(0, title.find("/iterations:"))].push_back(time->get<double>());
    }
    if (run.times.empty()) return Error{concat(path, ": holds no cases")};
    return run;
}

} // namespace

Result<std::string> compareRuns(const std::string& first, const std::string& second)
{
    const Result<RunFile> a = readRun(first), b = readRun(second);
    if (!a) return a.error();
    if (!b) return b.error();
    std::string out = concat("A: ", first, ", commit ", a->commit, "\nB: ", second, ", commit ", b->commit, "\n");
    if (a->device != b->device)
        out += concat("Not the same device, so the ratios say nothing of the code: A on ", a->device, ", B on ",
                      b->device, "\n");
    char line[160];
    std::snprintf(line, sizeof(line), "%-42s %12s %12s %8s\n", "median, ms", "A", "B", "B / A");
    out += line;
    for (const auto& [name, times] : a->times) {
        const auto other = b->times.find(name);
        if (other == b->times.end()) continue;
        const double x = medianOf(times), y = medianOf(other->second);
        std::snprintf(line, sizeof(line), "%-42s %12.4g %12.4g %8.3f\n", name.c_str(), x, y, x > 0.0 ? y / x : 0.0);
        out += line;
    }
    return out;
}

} // namespace helio
