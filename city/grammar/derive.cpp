// SPDX-License-Identifier: Apache-2.0
#include "city/grammar/derive.h"

#include <condition_variable>
#include <mutex>
#include <set>

#include "city/base/parallel.h"
#include "city/grammar/interpreter.h"

namespace helio {

namespace {

using namespace cga;

constexpr u32 kGrain = 4;  ///< buildings a thread takes at a time: they differ much in size
constexpr u32 kAhead = 64; ///< buildings a thread may be ahead of the one that is added next: what is in memory
constexpr size_t kMaxWarnings = 1000;
constexpr u32 kMaxRoofNotes = 20;

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
    std::vector<Warning> warnings;
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

    /// False if the tree's numbers would not fit into 32 bits.
    bool add(u32 building, BuildingShapes&& part)
    {
        if (tree_.shapes.size() + part.shapes.size() >= kNoIndex ||
            tree_.polygons.size() + part.polygons.size() >= kNoIndex ||
            tree_.trimPlanes.size() + part.trimPlanes.size() >= kNoIndex)
            return false;
        const u32 shapeBase = u32(tree_.shapes.size()), polygonBase = u32(tree_.polygons.size()),
                  trimBase = u32(tree_.trimPlanes.size());
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
            if (shape.trimCount > 0) shape.trimBegin += trimBase;
            if (shape.surface != kNoIndex) shape.surface = surfaces[shape.surface];
            if (shape.asset != kNoIndex) shape.asset = assets[shape.asset];
            tree_.shapes.push_back(shape);
        }
        std::move(part.polygons.begin(), part.polygons.end(), std::back_inserter(tree_.polygons));
        tree_.trimPlanes.insert(tree_.trimPlanes.end(), part.trimPlanes.begin(), part.trimPlanes.end());
        part = {};
        return true;
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

/// Takes buildings from all threads and adds them to the derivation in their order, so that the result does not depend
/// on who was first.
class Collector
{
public:
    Collector(const Program& program, std::span<const Footprint> footprints, const DeriveOptions& options)
        : footprints_(footprints), options_(options), ahead_(workerCount(options.jobs) * kAhead),
          merger_(program, derivation_.shapes)
    {
        derivation_.warnings = program.warnings;
        seen_.insert(program.warnings.begin(), program.warnings.end());
    }

    /// Waits until building k may be worked on; false when it is not needed any more.
    bool waitFor(u32 k)
    {
        std::unique_lock lock(mutex_);
        // The thread that has the next building to be added never waits: k is then next_ or less.
        moved_.wait(lock, [&] { return stopped_ || k < next_ + ahead_; });
        return !stopped_;
    }

    /// Takes a building; false when no more are needed.
    bool put(u32 k, BuildingResult&& result)
    {
        std::unique_lock lock(mutex_);
        if (stopped_) return false;
        waiting_.emplace(k, std::move(result));
        if (adding_) return true; // whoever adds at the moment will come to this one
        adding_ = true;
        while (!stopped_ && !waiting_.empty() && waiting_.begin()->first == next_) {
            auto node = waiting_.extract(waiting_.begin());
            lock.unlock(); // deriving goes on meanwhile; only this thread touches the derivation
            const bool go = add(node.key(), std::move(node.mapped()));
            lock.lock();
            ++next_;
            stopped_ = stopped_ || !go;
            moved_.notify_all();
        }
        adding_ = false;
        return !stopped_;
    }

    /// No building is needed any more: wakes those who wait.
    void stop()
    {
        const std::lock_guard lock(mutex_);
        stopped_ = true;
        moved_.notify_all();
    }

    /// After all threads have ended.
    Result<Derivation> finish()
    {
        if (error_) return *error_;
        HELIO_CHECK(next_ == footprints_.size(), next_, " of ", footprints_.size(), " buildings");
        derivation_.counts.shapes = derivation_.shapes.shapes.size();
        return std::move(derivation_);
    }

private:
    bool add(u32 k, BuildingResult&& result)
    {
        if (result.error) {
            error_ = std::move(result.error);
            return false;
        }
        for (Warning& warning : result.warnings)
            if (seen_.size() < kMaxWarnings && seen_.insert(warning.key).second)
                derivation_.warnings.push_back(std::move(warning.text));
        BuildingShapes& part = result.shapes;
        for (std::string& note : part.notes)
            if (noteCount_ < kMaxRoofNotes) {
                ++noteCount_;
                derivation_.warnings.push_back(std::move(note));
            }
        for (const auto& [key, value] : part.reports) derivation_.reports[key] += value;
        DeriveCounts& counts = derivation_.counts;
        for (const Shape& shape : part.shapes) {
            counts.leaves += shape.polygonCount > 0 || shape.asset != kNoIndex;
            counts.coveredLeaves += shape.covered;
        }
        counts.droppedOpenings += part.droppedOpenings;
        counts.roofs.roofs += part.roofs.roofs;
        counts.roofs.parts += part.roofs.parts;
        counts.roofs.flat += part.roofs.flat;
        derivation_.shapes.buildingIds.push_back(footprints_[k].id);
        if (!merger_.add(k, std::move(part))) {
            error_ = Error{concat("building '", footprints_[k].id, "': the city has more than ", kNoIndex,
                                  " shapes or polygons: derive a part of it (--bbox, --limit)")};
            return false;
        }
        if (options_.progress) options_.progress(k + 1, u32(footprints_.size()));
        if (options_.interrupted && k + 1 < footprints_.size() && options_.interrupted()) {
            error_ = Error{concat("interrupted after ", k + 1, " of ", footprints_.size(), " buildings")};
            return false;
        }
        return true;
    }

    std::span<const Footprint> footprints_;
    const DeriveOptions& options_;
    const u32 ahead_;

    std::mutex mutex_; ///< of what follows
    std::condition_variable moved_;
    std::map<u32, BuildingResult> waiting_; ///< done, but not yet added
    u32 next_ = 0;                          ///< building that is added next
    bool adding_ = false, stopped_ = false;

    // Of the thread that adds:
    Derivation derivation_;
    Merger merger_;
    std::set<std::string> seen_;
    std::optional<Error> error_;
    u32 noteCount_ = 0;
};

/// Stops the others when a thread leaves by an exception (out of memory, say): they would wait for its building.
class Guard
{
public:
    explicit Guard(Collector& collector) : collector_(&collector) {}
    ~Guard()
    {
        if (collector_) collector_->stop();
    }
    Guard(const Guard&) = delete;
    Guard& operator=(const Guard&) = delete;
    void done() { collector_ = nullptr; }

private:
    Collector* collector_;
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
    Collector collector(program, footprints, options);
    parallelFor(u32(footprints.size()), kGrain, options.jobs, [&](u32 begin, u32 end) {
        if (!collector.waitFor(begin)) return;
        Guard guard(collector);
        for (u32 k = begin; k < end; ++k) {
            const Footprint& footprint = footprints[k];
            // The id, not the number: adding a building must not change the others.
            const u64 seed = footprint.id.empty() ? mixSeed(options.seed, k) : hashText(footprint.id, options.seed);
            Trouble trouble(program.files, footprint.id, options.maxSteps);
            Interpreter interpreter(program, footprint, options, boxes, seed, trouble);
            BuildingResult result;
            result.shapes = interpreter.run(startRuleOf(program, footprint));
            result.warnings = trouble.warnings();
            if (trouble.failed()) result.error = trouble.error();
            if (!collector.put(k, std::move(result))) break;
        }
        guard.done();
    });
    return collector.finish();
}

} // namespace helio
