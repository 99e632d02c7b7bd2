// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/compare.h"

#include <array>
#include <cmath>
#include <cstdio>
#include <span>

#include "city/light/error_metrics.h"
#include "tools/support/complain.h"
#include "tools/support/light_csv.h"

namespace helio {
namespace {

constexpr std::array<const char*, 4> kQuantities{"E_sun", "E_sky", "E_indirect", "E_total"};

/// A column of a table; E_total is the sum of the other three. An empty vector: there is none.
std::vector<double> columnOf(const LightCsv& csv, const std::string& quantity, const std::string& channel)
{
    if (quantity != "E_total") {
        const auto found = csv.columns.find(quantity + "_" + channel);
        return found == csv.columns.end() ? std::vector<double>{} : found->second;
    }
    std::vector<double> sum(csv.rows, 0.0);
    for (size_t q = 0; q < 3; ++q) {
        const std::vector<double> part = columnOf(csv, kQuantities[q], channel);
        for (size_t i = 0; i < part.size(); ++i) sum[i] += part[i];
    }
    return sum;
}

Status checkTable(const LightCsv& csv, const std::string& path, bool reference)
{
    if (csv.rows == 0) return Error{concat(path, ": the table has no rows")};
    for (const char* channel : {"r", "g", "b", "solar"}) {
        for (size_t q = 0; q < kQuantities.size(); ++q) {
            const std::string name = kQuantities[q], value = concat(name, "_", channel),
                              error = concat(name, "_se_", channel);
            if (q < 3 && !csv.columns.contains(value))
                return Error{concat(path, ": no column ", value, "; a table of heliopolis-render --table is needed")};
            if (reference && !csv.columns.contains(error))
                return Error{concat(path, ": no column ", error, "; a table of heliopolis-bake reference is needed")};
        }
    }
    if (!csv.columns.contains("patch") || !csv.columns.contains("area"))
        return Error{concat(path, ": no columns patch and area; a table with a row a patch is needed")};
    return Nothing{};
}

Status checkSamePatches(const LightCsv& table, const LightCsv& reference, const CompareOptions& options)
{
    if (table.rows != reference.rows)
        return Error{concat(options.table, " has ", table.rows, " rows and ", options.reference, " ", reference.rows,
                            ": tables of one pack are needed")};
    for (size_t i = 0; i < table.rows; ++i) {
        const double area = reference.columns.at("area")[i];
        if (table.columns.at("patch")[i] != reference.columns.at("patch")[i] ||
            !(std::abs(table.columns.at("area")[i] - area) <= 1e-4 * area))
            return Error{concat(options.table, " and ", options.reference, " differ in the patch of row ", i,
                                ": tables of one pack are needed")};
    }
    return Nothing{};
}

/// Mean of the metrics over some channels.
ErrorMetrics judge(const LightCsv& table, const LightCsv& reference, const std::string& quantity,
                   std::span<const char* const> channels)
{
    ErrorMetrics mean;
    const std::vector<bool> all(table.rows, true);
    for (const char* channel : channels) {
        const ErrorMetrics m =
            compare(reference.columns.at("area"), columnOf(table, quantity, channel),
                    columnOf(reference, quantity, channel), columnOf(reference, quantity + "_se", channel), all);
        for (double ErrorMetrics::*figure :
             {&ErrorMetrics::rms, &ErrorMetrics::bias, &ErrorMetrics::p95, &ErrorMetrics::largest, &ErrorMetrics::noise,
              &ErrorMetrics::biasError, &ErrorMetrics::mean})
            mean.*figure += m.*figure / double(channels.size());
    }
    return mean;
}

void print(const char* quantity, const char* channels, const ErrorMetrics& m, bool json, bool last)
{
    if (json)
        std::printf("  {\"quantity\": \"%s\", \"channels\": \"%s\", \"mean\": %.9g, \"rms\": %.6g, \"bias\": %.6g, "
                    "\"bias_se\": %.6g, \"p95\": %.6g, \"max\": %.6g, \"noise\": %.6g}%s\n",
                    quantity, channels, m.mean, m.rms, m.bias, m.biasError, m.p95, m.largest, m.noise, last ? "" : ",");
    else
        std::printf("%-11s %-6s %12.5g %8.2f %+8.3f %8.3f %8.2f %9.1f %8.2f\n", quantity, channels, m.mean,
                    100.0 * m.rms, 100.0 * m.bias, 100.0 * m.biasError, 100.0 * m.p95, 100.0 * m.largest,
                    100.0 * m.noise);
}

} // namespace

CLI::App* addCompareCommand(CLI::App& app, CompareOptions& options)
{
    CLI::App* command = app.add_subcommand(
        "compare", "errors of a table of light against a reference, area weighted, in % of its mean");
    command->add_option("TABLE", options.table, "table of heliopolis-render --table")->required();
    command->add_option("REFERENCE", options.reference, "table of heliopolis-bake reference")->required();
    command->add_flag("--json", options.json, "print JSON, as fractions instead of %");
    return command;
}

int runCompare(const CompareOptions& options)
{
    const Result<LightCsv> table = readLightCsv(options.table), reference = readLightCsv(options.reference);
    if (!table) return complain(table.error().message, kBadInput);
    if (!reference) return complain(reference.error().message, kBadInput);
    Status status = checkTable(*table, options.table, false);
    if (status) status = checkTable(*reference, options.reference, true);
    if (status) status = checkSamePatches(*table, *reference, options);
    if (!status) return complain(status.error().message, kBadInput);

    constexpr const char* kColours[] = {"r", "g", "b"};
    constexpr const char* kSolar[] = {"solar"};
    if (options.json)
        std::printf("[\n");
    else
        std::printf("%% of the reference's mean; its noise is subtracted from rms, not from P95 and max\n"
                    "%-11s %-6s %12s %8s %8s %8s %8s %9s %8s\n",
                    "quantity", "of", "mean, W/m2", "rms", "bias", "+-", "P95", "max", "noise");
    for (const char* quantity : kQuantities) {
        print(quantity, "colour", judge(*table, *reference, quantity, kColours), options.json, false);
        print(quantity, "solar", judge(*table, *reference, quantity, kSolar), options.json,
              quantity == kQuantities.back());
    }
    if (options.json) std::printf("]\n");
    return kOk;
}

} // namespace helio
