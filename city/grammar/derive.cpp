// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/derive.h"

#include <mutex>
#include <set>

#include "city/base/parallel.h"
#include "city/grammar/interpreter.h"

namespace helio {

namespace {

using namespace cga;

constexpr u32 kGrain = 4; ///< buildings a thread takes at a time: they differ much in size

/// Asks the caller for each box once, one thread at a time.
class SharedBoxes final : public AssetBoxes
{
public:
    explicit SharedBoxes(const DeriveOptions& options) : options_(options) {}

    Result<AssetBox> find(const std::string& name) override
    {
        if (!options_.assetBox) return Error{"no assets are available here"};
        const std::lock_guard lock(mutex_);
        auto it = boxes_.find(name);
        if (it == boxes_.end()) it = boxes_.emplace(name, options_.assetBox(name)).first;
        return it->second;
    }

private:
    const DeriveOptions& options_;
    std::mutex mutex_;
    std::map<std::string, Result<AssetBox>> boxes_;
};

struct BuildingResult
{
    BuildingShapes shapes;
    std::vector<std::string> warnings;
    std::optional<Error> error;
};

/// The start rule of a footprint: its own, or the file's; kNoIndex if there is none.
u32 startRuleOf(const Program& program, const Footprint& footprint)
{
    if (footprint.rule.empty()) return program.startRule;
    const auto found = program.ruleIndex.find({footprint.rule, 0});
    return found == program.ruleIndex.end() ? kNoIndex : found->second;
}

/// Appends buildings one after the other; names, surfaces and assets get numbers in order of first use.
class Merger
{
public:
    Merger(const Program& program, ShapeTree& tree) : program_(program), tree_(tree) {}

    void add(u32 building, BuildingShapes&& part)
    {
        const u32 shapeBase = u32(tree_.shapes.size()), polygonBase = u32(tree_.polygons.size());
        std::vector<u32> surfaces, assets;
        for (Surface& surface : part.surfaces) surfaces.push_back(surfaceNumber(std::move(surface)));
        for (const std::string& asset : part.assets) assets.push_back(number(asset, assetNumbers_, tree_.assets));
        for (Shape& shape : part.shapes) {
            const std::string& name =
                shape.name < program_.names.size() ? program_.names[shape.name] : operationName(shape.name);
            shape.name = number(name, nameNumbers_, tree_.names);
            shape.building = building;
            if (shape.parent != kNoIndex) shape.parent += shapeBase;
            if (shape.polygonCount > 0) shape.polygonBegin += polygonBase;
            if (shape.surface != kNoIndex) shape.surface = surfaces[shape.surface];
            if (shape.asset != kNoIndex) shape.asset = assets[shape.asset];
            tree_.shapes.push_back(shape);
        }
        std::move(part.polygons.begin(), part.polygons.end(), std::back_inserter(tree_.polygons));
        part = {};
    }

private:
    const std::string& operationName(u32 name)
    {
        operationNames_.resize(std::size(kOperationNames));
        const size_t k = name - program_.names.size();
        operationNames_[k] = kOperationNames[k];
        return operationNames_[k];
    }

    static u32 number(const std::string& text, std::map<std::string, u32>& numbers, std::vector<std::string>& list)
    {
        const auto [it, added] = numbers.emplace(text, u32(list.size()));
        if (added) list.push_back(text);
        return it->second;
    }

    u32 surfaceNumber(Surface&& surface)
    {
        const auto key = std::tuple(surface.name, surface.rho.r, surface.rho.g, surface.rho.b, surface.rho.a,
                                    surface.emission.r, surface.emission.g, surface.emission.b);
        const auto [it, added] = surfaceNumbers_.emplace(key, u32(tree_.surfaces.size()));
        if (added) tree_.surfaces.push_back(std::move(surface));
        return it->second;
    }

    const Program& program_;
    ShapeTree& tree_;
    std::vector<std::string> operationNames_;
    std::map<std::string, u32> nameNumbers_, assetNumbers_;
    std::map<std::tuple<std::string, double, double, double, double, double, double, double>, u32> surfaceNumbers_;
};

} // namespace

Result<Derivation> derive(const RuleSet& rules, std::span<const Footprint> footprints, const DeriveOptions& options)
{
    const Program& program = rules.program();
    for (const auto& [name, value] : options.attributes) {
        const auto found = program.globalIndex.find({name, 0});
        if (found == program.globalIndex.end() || program.globals[found->second].kind != GlobalKind::Attribute)
            return Error{concat(program.fileName, ": the rules declare no attribute '", name, "' that could be set")};
    }
    for (const Footprint& footprint : footprints)
        if (startRuleOf(program, footprint) == kNoIndex)
            return Error{footprint.rule.empty()
                             ? concat(program.fileName, ": no start rule: name one Lot, or mark one with @StartRule")
                             : concat(program.fileName, ": building '", footprint.id, "': the start rule '",
                                      footprint.rule, "' is not declared, or it takes parameters")};

    SharedBoxes boxes(options);
    std::vector<BuildingResult> results(footprints.size());
    parallelFor(u32(footprints.size()), kGrain, options.jobs, [&](u32 begin, u32 end) {
        for (u32 k = begin; k < end; ++k) {
            const Footprint& footprint = footprints[k];
            // The id, not the number: adding a building must not change the others.
            const u64 seed = footprint.id.empty() ? mixSeed(options.seed, k) : hashText(footprint.id, options.seed);
            Trouble trouble(program.fileName, footprint.id);
            Interpreter interpreter(program, footprint, options, boxes, seed, trouble);
            results[k].shapes = interpreter.run(startRuleOf(program, footprint));
            results[k].warnings = trouble.warnings();
            if (trouble.failed()) results[k].error = trouble.error();
        }
    });

    Derivation derivation;
    derivation.warnings = program.warnings;
    std::set<std::string> seen(program.warnings.begin(), program.warnings.end());
    Merger merger(program, derivation.shapes);
    for (u32 k = 0; k < results.size(); ++k) {
        if (results[k].error) return *results[k].error;
        for (const std::string& warning : results[k].warnings)
            if (seen.insert(warning).second) derivation.warnings.push_back(warning);
        for (const auto& [key, value] : results[k].shapes.reports) derivation.reports[key] += value;
        derivation.shapes.buildingIds.push_back(footprints[k].id);
        merger.add(k, std::move(results[k].shapes));
    }
    return derivation;
}

} // namespace helio
