// SPDX-License-Identifier: Apache-2.0
#include "city/pack/pipeline.h"

#include <algorithm>
#include <charconv>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>

#include "city/base/file.h"
#include "city/base/hash.h"
#include "city/layout/builtin_city.h"
#include "city/layout/ground.h"
#include "city/layout/surfaces.h"
#include "city/pack/asset_library.h"
#include "city/pack/content_builder.h"
#include "city/pack/rule_source.h"

namespace helio {
namespace {

// Shipped rule files that hold without another choice.
constexpr const char* kBuiltinRules = "city.cga";
constexpr const char* kFootprintRules = "midrise.cga";
// Prague, where no input tells a place.
constexpr double kLatitudeDeg = 50.1, kLongitudeDeg = 14.4;

/// Reports steps and takes their times.
class StepClock
{
public:
    StepClock(const BakeOptions& options, std::vector<StepSeconds>& seconds) : options_(options), seconds_(seconds) {}

    void begin(const char* step)
    {
        end();
        step_ = step;
        start_ = std::chrono::steady_clock::now();
        if (options_.light.progress) options_.light.progress(step, 0.0);
    }
    void show(double done)
    {
        if (options_.light.progress && step_ != nullptr) options_.light.progress(step_, done);
    }
    void end()
    {
        if (step_ == nullptr) return;
        const std::chrono::duration<double> took = std::chrono::steady_clock::now() - start_;
        seconds_.push_back({step_, took.count()});
        step_ = nullptr;
    }

private:
    const BakeOptions& options_;
    std::vector<StepSeconds>& seconds_;
    const char* step_ = nullptr;
    std::chrono::steady_clock::time_point start_;
};

/// The bake in the making; one function a step.
class Pipeline
{
public:
    explicit Pipeline(const BakeOptions& options)
        : options_(options), clock_(options, out_.stats.seconds), library_(assetFolders(options))
    {
    }

    Result<BakeResult> run()
    {
        const bool scene = !options_.surfaces.empty();
        if (scene && options_.input.empty())
            return Error{
                concat(options_.surfaces.string(), ": a CSV of surfaces goes with an OBJ file, and none is given")};
        if (!scene && options_.input.extension() == ".obj")
            return Error{concat(options_.input.string(),
                                ": an OBJ scene needs the CSV of its surfaces; give it with --surfaces")};
        if (Status status = scene ? readScene() : growCity(); !status) return status.error();
        if (Status status = loadAssets(); !status) return status.error();
        buildTree();
        if (build_.tree.patches.empty())
            return Error{concat(sourceName(), ": nothing to light: no surface has an area")};
        if (!options_.treeOnly)
            if (Status status = lightTree(); !status) return status.error();
        describe();
        clock_.end();
        return std::move(out_);
    }

private:
    static std::vector<std::filesystem::path> assetFolders(const BakeOptions& options)
    {
        if (options.rules.empty()) return {};
        const std::filesystem::path folder = options.rules.parent_path();
        return {folder / "assets", folder / ".." / "assets"};
    }

    std::string sourceName() const
    {
        return options_.input.empty() ? "built-in city" : options_.input.filename().string();
    }

    Status hashInput(const std::filesystem::path& path)
    {
        Result<std::string> text = readTextFile(path);
        if (!text) return text.error();
        out_.content.index.inputHash = mixSeed(out_.content.index.inputHash, hashText(*text));
        return Nothing{};
    }

    Status readScene()
    {
        clock_.begin("import");
        for (const std::filesystem::path& path : {options_.input, options_.surfaces})
            if (Status status = hashInput(path); !status) return status;
        Result<ShapeTree> shapes = readSurfaces(options_.input, options_.surfaces);
        if (!shapes) return shapes.error();
        shapes_ = std::move(*shapes);
        for (const Shape& shape : shapes_.shapes)
            if (shape.sourceFace != kNoIndex)
                out_.content.index.sourceFaceCount = std::max(out_.content.index.sourceFaceCount, shape.sourceFace + 1);
        return Nothing{};
    }

    Status growCity()
    {
        clock_.begin("import");
        Result<Layout> layout = importLayout();
        if (!layout) return layout.error();
        if (layout->footprints.empty()) return Error{concat(sourceName(), ": no footprint to build on")};
        clock_.begin("rules");
        const char* shipped = options_.input.empty() ? kBuiltinRules : kFootprintRules;
        Result<RuleSource> source = readRules(options_.rules.empty() ? shipped : options_.rules, options_.style);
        if (!source) return source.error();
        out_.content.index.rules = source->name;
        out_.content.index.rulesHash = source->hash;
        // The built-in city names start rules of its own rule file; one without them starts where it says itself.
        const std::vector<std::string> known = source->rules.ruleNames();
        for (Footprint& footprint : layout->footprints)
            if (std::find(known.begin(), known.end(), footprint.rule) == known.end()) footprint.rule.clear();
        clock_.begin("ground");
        addGround(*layout);
        clock_.begin("derivation");
        Result<Derivation> derived = derive(source->rules, layout->footprints, deriveOptions());
        if (!derived) return derived.error();
        shapes_ = std::move(derived->shapes);
        appendGround(shapes_, *layout);
        out_.stats.derivation = derived->counts;
        out_.stats.import = std::move(layout->counts);
        out_.stats.reports = std::move(derived->reports);
        out_.stats.notes = std::move(layout->notes);
        out_.stats.notes.insert(out_.stats.notes.end(), derived->warnings.begin(), derived->warnings.end());
        out_.content.index.crs = layout->crs;
        out_.content.index.origin = layout->origin;
        latitudeDeg_ = layout->latitudeDeg.value_or(latitudeDeg_);
        longitudeDeg_ = layout->longitudeDeg.value_or(longitudeDeg_);
        return Nothing{};
    }

    DeriveOptions deriveOptions()
    {
        DeriveOptions derivation;
        derivation.seed = options_.light.seed;
        derivation.jobs = options_.light.jobs;
        derivation.attributes = options_.attributes;
        derivation.assetBox = [this](const std::string& name) -> Result<AssetBox> {
            Result<const AssetMesh*> mesh = library_.find(name);
            if (!mesh) return mesh.error();
            return AssetBox{(*mesh)->boxMin, (*mesh)->boxMax};
        };
        derivation.progress = [this](u32 done, u32 total) { clock_.show(double(done) / double(std::max(total, 1u))); };
        derivation.interrupted = options_.interrupted;
        return derivation;
    }

    Result<Layout> importLayout()
    {
        if (options_.input.empty()) return builtinCity(options_.light.seed);
        if (Status status = hashInput(options_.input); !status) return status.error();
        if (!options_.import.streets.empty())
            if (Status status = hashInput(options_.import.streets); !status) return status.error();
        return importCity(options_.input, options_.import);
    }

    Status loadAssets()
    {
        clock_.begin("assets");
        for (const std::string& name : shapes_.assets) {
            Result<const AssetMesh*> mesh = library_.find(name);
            if (!mesh) return mesh.error();
            meshes_.push_back(**mesh);
            summaries_.push_back({meshes_.back().rho, 0.5 * (meshes_.back().boxMin + meshes_.back().boxMax)});
            out_.content.index.rulesHash = mixSeed(out_.content.index.rulesHash, library_.hashOf(name));
        }
        return Nothing{};
    }

    void buildTree()
    {
        clock_.begin("nodes");
        build_ = buildNodes(std::move(shapes_), summaries_, options_.nodes);
        shapes_ = {};
    }

    Status lightTree()
    {
        clock_.begin("light");
        LightOptions lighting = options_.light;
        // A scene of polygons is lit as it is; around a city the ground goes on.
        if (options_.surfaces.empty()) lighting.farGround = groundSurface(kOuterGround).rho;
        LightBake light = bakeLight(build_, summaries_, lighting);
        out_.stats.light = light.stats;
        clock_.begin("content");
        PackIndex index = std::move(out_.content.index);
        Result<PackContent> content = buildContent(build_, meshes_, std::move(light));
        if (!content) return Error{concat(sourceName(), ": ", content.error().message)};
        out_.content = std::move(*content);
        index.boundsMin = out_.content.index.boundsMin;
        index.boundsMax = out_.content.index.boundsMax;
        out_.content.index = std::move(index);
        return Nothing{};
    }

    void describe()
    {
        PackIndex& index = out_.content.index;
        index.latitudeDeg = options_.latitudeDeg.value_or(latitudeDeg_);
        index.longitudeDeg = options_.longitudeDeg.value_or(longitudeDeg_);
        index.northDeg = options_.northDeg;
        index.source = sourceName();
        index.method = methodName(options_.light.method);
        index.seed = options_.light.seed;
        nlohmann::ordered_json settings = {{"error", options_.light.error},
                                           {"split_growth", options_.light.splitGrowth},
                                           {"senders", options_.light.constantSenders ? "constant" : "linear"},
                                           {"receivers", options_.light.leafReceivers ? "patches" : "tree"},
                                           {"epsilon", options_.light.formFactorEpsilon},
                                           {"rays_per_patch", options_.light.raysPerPatch},
                                           {"sky_patches", options_.light.skyPatches},
                                           {"rays_per_link", options_.light.raysPerLink},
                                           {"cutoff_m", options_.light.cutoff},
                                           {"default_height_m", options_.import.defaultHeight},
                                           {"patch", options_.nodes.patch == PatchMode::Bay ? "bay" : "piece"},
                                           {"tree", treeShapeName(options_.nodes.tree)}};
        if (!options_.style.empty()) settings["style"] = options_.style;
        if (options_.import.lod2) settings["surfaces"] = "lod2";
        for (const auto& [name, value] : options_.attributes)
            std::visit([&, key = name](const auto& plain) { settings["attributes"][key] = plain; }, value);
        index.options = settings.dump(-1, ' ', false, nlohmann::ordered_json::error_handler_t::replace);

        BakeStats& stats = out_.stats;
        stats.buildings = u32(build_.tree.buildingIds.size());
        stats.nodes = build_.tree.nodeCount();
        stats.patches = build_.tree.patchCount();
        stats.instances = u32(build_.instances.size());
        for (const gpu::DrawRecord& draw : out_.content.draws)
            stats.triangles += u64(draw.indexCount / 3) * draw.instanceCount;
        stats.degeneratePolygons = build_.degenerateCount;
        stats.orphanOverlays = build_.orphanOverlayCount;
        stats.areaDefect = build_.areaDefect;
        stats.treeOnly = options_.treeOnly;
        stats.coveredPatches = build_.coveredPatchCount;
        stats.coveredArea = build_.coveredArea;
        stats.mergedLeaves = build_.mergedCount;
        stats.slivers = build_.sliverCount;
        stats.strips = build_.stripCount;
        stats.overlappingNodes = build_.overlapCount;
        if (build_.overlapCount > 0)
            stats.notes.push_back(concat("nodes: in ", build_.overlapCount,
                                         " plane nodes polygons lie on each other (by up to ",
                                         100.0 * build_.areaDefect, " % of the outline): a face that is there twice?"));
    }

    const BakeOptions& options_;
    double latitudeDeg_ = kLatitudeDeg, longitudeDeg_ = kLongitudeDeg;
    BakeResult out_;
    StepClock clock_;
    AssetLibrary library_;
    ShapeTree shapes_;
    std::vector<AssetMesh> meshes_; ///< parallel to ShapeTree::assets
    std::vector<AssetSummary> summaries_;
    NodeTreeBuild build_;
};

} // namespace

Result<BakeResult> bake(const BakeOptions& options)
{
    return Pipeline(options).run();
}

Attribute attributeFromText(const std::string& text)
{
    double number = 0.0;
    const auto [end, failure] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (failure == std::errc{} && end == text.data() + text.size() && std::isfinite(number)) return number;
    if (text == "true" || text == "false") return text == "true";
    return text;
}

const char* methodName(LinkMethod method)
{
    switch (method) {
    case LinkMethod::Heliopolis:
        return "heliopolis";
    case LinkMethod::Paper:
        return "paper";
    case LinkMethod::PaperLiteral:
        return "paper-literal";
    }
    HELIO_CHECK(false, int(method));
}

} // namespace helio
