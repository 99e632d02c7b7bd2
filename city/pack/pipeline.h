// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <filesystem>
#include <functional>
#include <map>
#include <optional>

#include "city/grammar/derive.h"
#include "city/layout/import.h"
#include "city/light/bake_light.h"
#include "city/model/build_nodes.h"
#include "city/pack/content.h"

namespace helio {

/// What to bake, and how.
struct BakeOptions
{
    /// GeoJSON or CityJSON footprints, or OBJ polygons with `surfaces`; empty: the built-in city
    std::filesystem::path input;
    std::filesystem::path surfaces; ///< CSV of an OBJ scene
    ImportOptions import;           ///< of footprints
    /// Rule file, or the name of a shipped one; empty: city.cga for the built-in city, else midrise.cga. Assets: its
    /// folder's assets/, ../assets/, the shipped ones
    std::filesystem::path rules;
    std::string style; ///< of the rule file; empty: Default
    NodeOptions nodes; ///< how leaves become patches
    /// Of the tile's origin, for suns by date, degrees; empty: where the input says that it lies, else 50.1, 14.4
    std::optional<double> latitudeDeg, longitudeDeg;
    double northDeg = 0.0;             ///< clockwise from true north to +y, degrees
    bool treeOnly = false;             ///< stop after the node tree: statistics, but no links and no content
    std::function<bool()> interrupted; ///< asked now and then: true stops the bake with an error
    std::map<std::string, Attribute>
        attributes;     ///< of the rules, for all buildings; win over the footprints' properties
    LightOptions light; ///< method, thresholds, jobs and seed; jobs and seed hold for all steps
};

/// What a bake says about itself. Only the seconds and the memory differ from run to run.
struct BakeStats
{
    u32 buildings = 0, nodes = 0, patches = 0, instances = 0;
    u64 triangles = 0; ///< drawn, instances counted
    u32 degeneratePolygons = 0, orphanOverlays = 0;
    u32 overlappingNodes = 0;                      ///< planar nodes whose children overlap
    double areaDefect = 0.0;                       ///< area ledger: see NodeTreeBuild::areaDefect
    u32 coveredPatches = 0;                        ///< on walls that a neighbour covers: they exchange no light
    double coveredArea = 0.0;                      ///< m2 of these
    u32 mergedLeaves = 0, slivers = 0, strips = 0; ///< see NodeTreeBuild
    bool treeOnly = false;
    DeriveCounts derivation;
    std::map<std::string, u32> import; ///< census and repairs: Layout::counts
    LightStats light;
    LinkBytes linkBytes;                   ///< of the pack, once it is written (writePack)
    std::map<std::string, double> reports; ///< report() of the rules, summed per key
    std::vector<std::string> notes;        ///< repaired or skipped input and warnings of the rules, one line each
    std::vector<StepSeconds> seconds;      ///< of each step, in order
};

struct BakeResult
{
    PackContent content;
    BakeStats stats;
};

/// Footprints or polygons to the content of a pack: import, ground, rules, assets, node tree, links. Content depends on
/// the input and the options alone, not on light.jobs. Errors are one line; nothing is written.
Result<BakeResult> bake(const BakeOptions& options);

/// The value that NAME=TEXT gives an attribute: a number, true or false, else the text itself.
Attribute attributeFromText(const std::string& text);

/// "heliopolis", "paper" or "paper-literal".
const char* methodName(LinkMethod method);

} // namespace helio
