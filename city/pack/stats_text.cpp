// SPDX-License-Identifier: Apache-2.0
#include "city/pack/stats_text.h"

#include <algorithm>
#include <cstdio>
#include <nlohmann/json.hpp>
#include <sys/resource.h>

namespace helio {
namespace {

constexpr size_t kMostNotes = 10; ///< shown; the JSON file has them all

template <class... Ts> std::string printed(const char* format, Ts... values)
{
    char buffer[512];
    std::snprintf(buffer, sizeof buffer, format, values...);
    return buffer;
}

template <class... Ts> void line(std::string& text, const char* format, Ts... values)
{
    text += printed(format, values...) + '\n';
}

void rangeLine(std::string& text, const char* name, const MinMeanMax& range)
{
    line(text, "  %-20s min %.5f  mean %.5f  max %.5f", name, range.min, range.mean, range.max);
}

void secondsLine(std::string& text, const char* name, const std::vector<StepSeconds>& steps)
{
    double total = 0.0;
    text += printed("  %-20s ", name);
    for (const StepSeconds& step : steps) {
        text += printed("%s %.2f, ", step.step.c_str(), step.seconds);
        total += step.seconds;
    }
    line(text, "total %.2f", total);
}

nlohmann::ordered_json rangeJson(const MinMeanMax& range)
{
    return {{"min", range.min}, {"mean", range.mean}, {"max", range.max}};
}

nlohmann::ordered_json secondsJson(const std::vector<StepSeconds>& steps)
{
    nlohmann::ordered_json json = nlohmann::ordered_json::array();
    for (const StepSeconds& step : steps) json.push_back({{"step", step.step}, {"seconds", step.seconds}});
    return json;
}

void lightLines(std::string& text, const LightStats& light)
{
    if (light.splitPatchCount > light.wholePatchCount)
        line(text, "  %u patches were split to %u, unresolved light inside them %.2f %%", light.wholePatchCount,
             light.splitPatchCount, 100.0 * light.unresolved);
    if (light.predicted.total > 0.0)
        line(text, "  predicted error %.2f %% of E_indirect under suns (links %.2f, patches %.2f), %.2f %% under a sky",
             100.0 * light.predicted.total, 100.0 * light.predicted.links, 100.0 * light.predicted.patches,
             100.0 * light.predicted.sky);
    line(text, "  links %llu, %.1f per patch", static_cast<unsigned long long>(light.linkCount), light.linksPerPatch);
    rangeLine(text, "row sum + sky (1)", light.closure);
    rangeLine(text, "row sum of links", light.rowSum);
    rangeLine(text, "row sum by rays", light.rayRowSum);
    rangeLine(text, "sky by rays", light.sky);
    rangeLine(text, light.farGround ? "far ground by rays" : "void by rays", light.below);
    line(text, "  %-20s %+.3f %%%s", "closure defect", 100.0 * light.closureDefect,
         std::abs(light.closureDefect) > 0.01 ? "  (more than 1 %: senders are missing or counted twice)" : "");
    if (light.insidePatchCount > 0)
        line(text,
             "  %-20s %u patches, %.2f %% of the area: party walls and what stands inside a neighbour; not in the "
             "sums above",
             "inside", light.insidePatchCount, 100.0 * light.insideAreaShare);
    line(text, "  %-20s error a link may leave %.3g, rays %u a patch, %u a link", "thresholds", light.formFactorEpsilon,
         light.raysPerPatch, light.raysPerLink);
}

void derivationLines(std::string& text, const BakeStats& stats)
{
    const DeriveCounts& made = stats.derivation;
    line(text, "  %-20s %llu shapes, %llu leaves; %llu roofs, of these simpler than asked %llu, flat %llu",
         "derivation", static_cast<unsigned long long>(made.shapes), static_cast<unsigned long long>(made.leaves),
         static_cast<unsigned long long>(made.roofs.roofs), static_cast<unsigned long long>(made.roofs.parts),
         static_cast<unsigned long long>(made.roofs.flat));
    line(text, "  %-20s %u patches, %.0f m2, exchange no light; %llu openings left out", "behind neighbours",
         stats.coveredPatches, stats.coveredArea, static_cast<unsigned long long>(made.droppedOpenings));
    line(text, "  %-20s %u leaves merged into others, %u of them slivers; %u strips cut", "patches", stats.mergedLeaves,
         stats.slivers, stats.strips);
}

void addLight(nlohmann::ordered_json& json, const LightStats& light)
{
    json["whole_patches"] = light.wholePatchCount;
    json["split_patches"] = light.splitPatchCount;
    json["unresolved"] = light.unresolved;
    json["predicted_error"] = light.predicted.total;
    json["predicted_error_of_links"] = light.predicted.links;
    json["predicted_error_of_patches"] = light.predicted.patches;
    json["predicted_error_sky"] = light.predicted.sky;
    json["links"] = light.linkCount;
    json["links_per_patch"] = light.linksPerPatch;
    json["planar_root_pairs"] = light.rootPairCount;
    json["pairs_evaluated"] = light.pairsEvaluated;
    json["rays_per_patch"] = light.raysPerPatch;
    json["row_sum_plus_sky"] = rangeJson(light.closure);
    json["row_sum_links"] = rangeJson(light.rowSum);
    json["row_sum_rays"] = rangeJson(light.rayRowSum);
    json["sky_rays"] = rangeJson(light.sky);
    json["far_ground"] = light.farGround;
    json["below_horizon_rays"] = rangeJson(light.below);
    json["closure_defect"] = light.closureDefect;
    json["inside_patches"] = light.insidePatchCount;
    json["inside_area_share"] = light.insideAreaShare;
    json["error_a_link_may_leave"] = light.formFactorEpsilon;
    json["rays_per_link"] = light.raysPerLink;
}

nlohmann::ordered_json derivationJson(const BakeStats& stats)
{
    const DeriveCounts& made = stats.derivation;
    return {{"shapes", made.shapes},
            {"leaves", made.leaves},
            {"covered_leaves", made.coveredLeaves},
            {"dropped_openings", made.droppedOpenings},
            {"roofs", made.roofs.roofs},
            {"roofs_simplified", made.roofs.parts},
            {"roofs_flat", made.roofs.flat}};
}

/// Per link; a pack without links has none.
nlohmann::ordered_json linkBytesJson(const BakeStats& stats)
{
    const double count = double(std::max<u64>(stats.light.linkCount, 1));
    const LinkBytes& bytes = stats.linkBytes;
    return {{"columns", double(bytes.columns) / count},
            {"factors", double(bytes.factors) / count},
            {"moments", double(bytes.moments) / count},
            {"per_link", double(bytes.columns + bytes.factors + bytes.moments) / count}};
}

} // namespace

double peakMemoryMiB()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024.0; // Linux counts KiB.
}

std::string linkBytesText(const LinkBytes& bytes, u64 linkCount)
{
    const double count = double(std::max<u64>(linkCount, 1));
    return printed("columns %.2f, factors %.2f, moments %.2f, in all %.2f", double(bytes.columns) / count,
                   double(bytes.factors) / count, double(bytes.moments) / count,
                   double(bytes.columns + bytes.factors + bytes.moments) / count);
}

std::string statsText(const BakeStats& stats, double peakMiB)
{
    std::string text;
    line(text, "  buildings %u, nodes %u, patches %u, asset instances %u, triangles %llu", stats.buildings, stats.nodes,
         stats.patches, stats.instances, static_cast<unsigned long long>(stats.triangles));
    if (stats.derivation.shapes > 0) derivationLines(text, stats);
    if (!stats.treeOnly) {
        lightLines(text, stats.light);
        line(text, "  %-20s %s", "bytes a link", linkBytesText(stats.linkBytes, stats.light.linkCount).c_str());
    }
    line(text, "  %-20s %.2e", "area-ledger defect", stats.areaDefect);
    if (stats.overlappingNodes > 0)
        line(text, "  %-20s %u (their children have more area than their outline)", "overlapping nodes",
             stats.overlappingNodes);
    if (stats.degeneratePolygons > 0)
        line(text, "  %-20s %u (area below 1e-8 m2)", "dropped polygons", stats.degeneratePolygons);
    if (stats.orphanOverlays > 0)
        line(text, "  %-20s %u (no patch behind them)", "dropped assets", stats.orphanOverlays);
    for (const auto& [key, value] : stats.reports) line(text, "  report %-13s %.6g", key.c_str(), value);
    secondsLine(text, "seconds", stats.seconds);
    if (!stats.treeOnly) secondsLine(text, "of which light", stats.light.seconds);
    line(text, "  %-20s %.0f MiB", "peak memory", peakMiB);
    for (size_t i = 0; i < std::min(stats.notes.size(), kMostNotes); ++i) text += "  note: " + stats.notes[i] + '\n';
    if (stats.notes.size() > kMostNotes) line(text, "  and %zu more notes", stats.notes.size() - kMostNotes);
    return text;
}

std::string statsJson(const BakeStats& stats, double peakMiB)
{
    nlohmann::ordered_json json;
    json["buildings"] = stats.buildings;
    json["nodes"] = stats.nodes;
    json["patches"] = stats.patches;
    json["asset_instances"] = stats.instances;
    json["triangles"] = stats.triangles;
    if (stats.derivation.shapes > 0) json["derivation"] = derivationJson(stats);
    if (!stats.import.empty()) json["import"] = stats.import;
    json["covered_patches"] = stats.coveredPatches;
    json["covered_area_m2"] = stats.coveredArea;
    json["merged_leaves"] = stats.mergedLeaves;
    json["slivers"] = stats.slivers;
    json["strips"] = stats.strips;
    if (!stats.treeOnly) {
        addLight(json, stats.light);
        json["link_bytes"] = linkBytesJson(stats);
    }
    json["area_ledger_defect"] = stats.areaDefect;
    json["overlapping_nodes"] = stats.overlappingNodes;
    json["dropped_polygons"] = stats.degeneratePolygons;
    json["dropped_assets"] = stats.orphanOverlays;
    json["report"] = stats.reports;
    json["seconds"] = secondsJson(stats.seconds);
    if (!stats.treeOnly) json["seconds_light"] = secondsJson(stats.light.seconds);
    json["peak_memory_mib"] = peakMiB;
    json["bytes_per_node"] = stats.nodes > 0 ? peakMiB * 1048576.0 / stats.nodes : 0.0;
    json["notes"] = stats.notes;
    return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + '\n';
}

} // namespace helio
