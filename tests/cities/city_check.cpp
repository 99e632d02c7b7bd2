// SPDX-License-Identifier: Apache-2.0
// Imports and derives whole cities and checks what must hold of every light hierarchy; prints one block for each city
// and rule file. Lines that begin with "census", "note" and "result" are for tools/check_cities.
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <string>
#include <sys/resource.h>
#include <vector>

#include "city/grammar/derive.h"
#include "city/layout/ground.h"
#include "city/layout/import.h"
#include "city/pack/asset_library.h"
#include "city/pack/rule_source.h"
#include "tests/cities/tree_audit.h"
#include "tests/cities/tree_hash.h"

using namespace helio;

namespace {

struct Options
{
    std::vector<std::filesystem::path> rules, cities;
    std::vector<PatchMode> modes{PatchMode::Piece, PatchMode::Bay};
    bool unmerged = false, inwards = true, ground = true;
    bool census = false;  ///< print what the import counted and did
    bool compare = false; ///< derive with 1, 2 and 3 threads: all must be equal
    ImportOptions import;
};

class Clock
{
public:
    double seconds() const { return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count(); }

private:
    std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

double peakMiB()
{
    rusage usage{};
    getrusage(RUSAGE_SELF, &usage);
    return double(usage.ru_maxrss) / 1024.0;
}

/// What the checks of one city and rule file add up to.
struct Findings
{
    u32 patches = 0;
    double buildSeconds = 0.0;
    u64 faults = 0, inwards = 0;
    double ledger = 0.0;
    bool good = true;
};

/// Builds and audits one hierarchy.
void checkNodes(const char* name, const ShapeTree& shapes, const std::vector<AssetSummary>& assets,
                const NodeOptions& nodeOptions, bool inwards, Findings& findings)
{
    const Clock clock;
    const NodeTreeBuild build = buildNodes(shapes, assets, nodeOptions);
    const double seconds = clock.seconds();
    const TreeAudit audit = auditTree(build, shapes, inwards, 0);
    const NodeTree& tree = build.tree;
    u32 tiling = 0, partial = 0, cluster = 0, depth = 0;
    for (u32 i = tree.patchCount(); i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        (node.kind == NodeKind::Tiling ? tiling : node.kind == NodeKind::PlanarPartial ? partial : cluster) += 1;
        if (node.kind != NodeKind::Cluster) depth = std::max(depth, node.height);
    }
    const u32 nodes = std::max(1u, tree.nodeCount());
    size_t openings = 0;
    for (const AssetInstance& instance : build.instances) openings += instance.piece != kNoIndex ? 1 : 0;
    std::printf("  %-9s patches %u (openings %zu), nodes %u (inner: tiling %u, partial %u, cluster %u; planar depth "
                "%u), merged %u, "
                "slivers %u, strips %u, covered %u (%.0f m2)\n",
                name, tree.patchCount(), openings, tree.nodeCount(), tiling, partial, cluster, depth, build.mergedCount,
                build.sliverCount, build.stripCount, build.coveredPatchCount, build.coveredArea);
    std::printf("            %.2f s, %.0f bytes a node, ledger: area %.1e, rho %.1e, nodes %.1e, overlaps %u\n",
                seconds, double(bytesOf(build)) / double(nodes), audit.areaLedger, audit.rhoLedger, build.areaDefect,
                build.overlapCount);
    std::printf("            faults: not finite %llu, no area %llu, normal %llu, outline %llu, sum %llu, order %llu, "
                "covered mixed %llu, inwards %llu; %s\n",
                static_cast<unsigned long long>(audit.notFinite), static_cast<unsigned long long>(audit.noArea),
                static_cast<unsigned long long>(audit.badNormal), static_cast<unsigned long long>(audit.badOutline),
                static_cast<unsigned long long>(audit.badSum), static_cast<unsigned long long>(audit.badLink),
                static_cast<unsigned long long>(audit.mixedCovered),
                static_cast<unsigned long long>(audit.facesInwards), audit.good() ? "good" : "WRONG");
    for (const auto& [rule, count] : audit.inwardsByName)
        std::printf("            %llu of '%s' face inwards\n", static_cast<unsigned long long>(count), rule.c_str());
    for (const std::string& line : audit.examples) std::printf("            %s\n", line.c_str());
    std::printf("            hash %016llx\n", static_cast<unsigned long long>(hashOf(build)));
    findings.patches = tree.patchCount();
    findings.buildSeconds += seconds;
    findings.faults += audit.notFinite + audit.noArea + audit.badNormal + audit.badOutline + audit.badSum +
                       audit.badLink + audit.mixedCovered;
    findings.inwards += audit.facesInwards;
    findings.ledger = std::max({findings.ledger, audit.areaLedger, audit.rhoLedger, build.areaDefect});
    findings.good = findings.good && audit.good() && build.areaDefect <= 1e-5;
}

Result<bool> checkRules(const Options& options, const std::filesystem::path& rulesPath, const Layout& layout,
                        const std::filesystem::path& city)
{
    const Result<RuleSource> source = readRules(rulesPath, "");
    if (!source) return source.error();
    AssetLibrary library({rulesPath.parent_path() / "assets", rulesPath.parent_path() / ".." / "assets"});
    DeriveOptions derivation;
    derivation.assetBox = [&](const std::string& name) -> Result<AssetBox> {
        Result<const AssetMesh*> mesh = library.find(name);
        if (!mesh) return mesh.error();
        return AssetBox{(*mesh)->boxMin, (*mesh)->boxMax};
    };
    const Clock clock;
    Result<Derivation> derived = derive(source->rules, layout.footprints, derivation);
    if (!derived) return derived.error();
    const double seconds = clock.seconds();
    Findings findings;
    const u64 hash = hashOf(derived->shapes);
    for (u32 jobs = 1; options.compare && jobs <= 3; ++jobs) {
        derivation.jobs = jobs;
        const Result<Derivation> again = derive(source->rules, layout.footprints, derivation);
        if (again && hashOf(again->shapes) == hash) continue;
        std::printf("  with %u threads the derivation is another one\n", jobs);
        findings.good = false;
    }
    ShapeTree& shapes = derived->shapes;
    appendGround(shapes, layout);
    std::vector<AssetSummary> assets;
    for (const std::string& name : shapes.assets) {
        Result<const AssetMesh*> mesh = library.find(name);
        if (!mesh) return mesh.error();
        assets.push_back({(*mesh)->rho, 0.5 * ((*mesh)->boxMin + (*mesh)->boxMax)});
    }
    size_t leaves = 0;
    for (const Shape& shape : shapes.shapes) leaves += shape.polygonCount > 0 || shape.asset != kNoIndex ? 1 : 0;
    const RoofCounts& roofs = derived->counts.roofs;
    std::printf("%s on %s: buildings %zu, shapes %zu, leaves %zu, derived in %.2f s; roofs %llu, simpler %llu, flat "
                "%llu; hash %016llx; peak %.0f MiB\n",
                rulesPath.filename().c_str(), city.c_str(), layout.footprints.size(), shapes.shapes.size(), leaves,
                seconds, static_cast<unsigned long long>(roofs.roofs), static_cast<unsigned long long>(roofs.parts),
                static_cast<unsigned long long>(roofs.flat), static_cast<unsigned long long>(hash), peakMiB());
    for (const std::string& warning : derived->warnings) std::printf("  %s\n", warning.c_str());
    if (100 * (roofs.parts + roofs.flat) > roofs.roofs) {
        std::printf("  more than 1 %% of the roofs had to be simplified\n");
        findings.good = false;
    }
    if (options.unmerged) {
        NodeOptions plain;
        plain.mergeSize = plain.stripHeight = 0.0;
        checkNodes("unmerged", shapes, assets, plain, false, findings);
    }
    for (const PatchMode mode : options.modes) {
        NodeOptions nodeOptions;
        nodeOptions.patch = mode;
        checkNodes(mode == PatchMode::Bay ? "bay" : "piece", shapes, assets, nodeOptions, options.inwards, findings);
    }
    std::printf("result %s buildings=%zu leaves=%zu patches=%u seconds=%.2f peak_mib=%.0f roofs=%llu fallbacks=%llu "
                "faults=%llu inwards=%llu ledger=%.1e %s\n",
                rulesPath.filename().c_str(), layout.footprints.size(), leaves, findings.patches,
                seconds + findings.buildSeconds, peakMiB(), static_cast<unsigned long long>(roofs.roofs),
                static_cast<unsigned long long>(roofs.parts + roofs.flat),
                static_cast<unsigned long long>(findings.faults), static_cast<unsigned long long>(findings.inwards),
                findings.ledger, findings.good ? "good" : "WRONG");
    return findings.good;
}

/// Imports a city and checks it with all rule files.
Result<bool> checkCity(const Options& options, const std::filesystem::path& city)
{
    Result<Layout> layout = importCity(city, options.import);
    if (!layout) return layout.error();
    if (options.census) {
        for (const auto& [name, count] : layout->counts) std::printf("census %s = %u\n", name.c_str(), count);
        for (const std::string& note : layout->notes) std::printf("note %s\n", note.c_str());
        for (const Footprint& footprint : layout->footprints) std::printf("kept %s\n", footprint.id.c_str());
    }
    if (options.ground) addGround(*layout);
    bool good = true;
    for (const std::filesystem::path& rules : options.rules) {
        const Result<bool> result = checkRules(options, rules, *layout, city);
        if (!result) std::printf("%s\n", result.error().message.c_str());
        good = good && result && *result;
        std::fflush(stdout);
    }
    return good;
}

} // namespace

int main(int argc, char** argv)
{
    Options options;
    for (int i = 1; i < argc; ++i) {
        const std::string word = argv[i];
        if (word == "--unmerged")
            options.unmerged = true;
        else if (word == "--no-inwards")
            options.inwards = false;
        else if (word == "--no-ground")
            options.ground = false;
        else if (word == "--census")
            options.census = true;
        else if (word == "--jobs")
            options.compare = true;
        else if (word == "--lod2")
            options.import.lod2 = true;
        else if (word == "--streets" && i + 1 < argc)
            options.import.streets = argv[++i];
        else if (word == "--piece" || word == "--bay")
            options.modes = {word == "--bay" ? PatchMode::Bay : PatchMode::Piece};
        else
            (word.ends_with(".cga") ? options.rules : options.cities).push_back(word);
    }
    if (options.cities.empty() || (options.rules.empty() && !options.census)) {
        std::fputs("usage: city_check [--piece|--bay] [--unmerged] [--no-inwards] [--no-ground] [--jobs] [--lod2]\n"
                   "                  [--streets STREETS.geojson] [--census] RULES.cga... CITY...\n",
                   stderr);
        return 1;
    }
    bool good = true;
    for (const std::filesystem::path& city : options.cities) {
        const Result<bool> result = checkCity(options, city);
        if (!result) std::printf("%s\n", result.error().message.c_str());
        good = good && result && *result;
    }
    std::puts(good ? "all good" : "NOT GOOD");
    return good ? 0 : 1;
}
