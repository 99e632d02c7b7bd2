// SPDX-License-Identifier: Apache-2.0
// Any text as a rule file must give rules or an error; rules must give a derivation or an error within the limits, with
// finite coordinates, and a derivation a node tree.
#include <cmath>

#include "city/grammar/derive.h"
#include "city/grammar/explain.h"
#include "city/model/build_nodes.h"
#include "tests/fuzz/text_target.h"

namespace helio::fuzz {

namespace {

constexpr u64 kMaxSteps = 100000; // of one building

constexpr std::string_view kWords[] = {"alignScopeToAxes",
                                       "alignScopeToGeometry",
                                       "alignScopeToGeometryBBox",
                                       "center",
                                       "cleanupGeometry",
                                       "color",
                                       "comp",
                                       "deleteHoles",
                                       "extrude",
                                       "innerRect",
                                       "innerRectangle",
                                       "i",
                                       "mirror",
                                       "mirrorScope",
                                       "NIL",
                                       "offset",
                                       "primitiveCone",
                                       "primitiveCube",
                                       "primitiveCylinder",
                                       "primitiveDisk",
                                       "primitiveQuad",
                                       "primitiveSphere",
                                       "print",
                                       "report",
                                       "resize",
                                       "r",
                                       "roofGable",
                                       "roofHip",
                                       "roofPyramid",
                                       "roofShed",
                                       "reverseNormals",
                                       "rotate",
                                       "rotateScope",
                                       "s",
                                       "scatter",
                                       "uniform",
                                       "gaussian",
                                       "taper",
                                       "set",
                                       "setback",
                                       "setbackPerEdge",
                                       "setPivot",
                                       "shapeL",
                                       "shapeO",
                                       "shapeU",
                                       "split",
                                       "t",
                                       "translate",
                                       "trim",
                                       "texture",
                                       "setupProjection",
                                       "projectUV",
                                       "abs",
                                       "ceil",
                                       "clamp",
                                       "cos",
                                       "count",
                                       "find",
                                       "float",
                                       "floor",
                                       "inside",
                                       "overlaps",
                                       "touches",
                                       "inter",
                                       "intra",
                                       "isinf",
                                       "isnan",
                                       "len",
                                       "ln",
                                       "log10",
                                       "max",
                                       "min",
                                       "p",
                                       "pow",
                                       "rand",
                                       "replace",
                                       "rgb",
                                       "rint",
                                       "sin",
                                       "sqrt",
                                       "str",
                                       "substring",
                                       "tan",
                                       "geometry.area",
                                       "geometry.boundaryLength",
                                       "geometry.height",
                                       "geometry.isConcave",
                                       "geometry.nFaces",
                                       "geometry.nHoles",
                                       "geometry.volume",
                                       "scope.sx",
                                       "scope.sy",
                                       "scope.sz",
                                       "scope.tx",
                                       "scope.elevation",
                                       "split.index",
                                       "split.total",
                                       "comp.index",
                                       "comp.sel",
                                       "seedian",
                                       "material.name",
                                       "material.color.rgb",
                                       "trim.vertical",
                                       "x",
                                       "y",
                                       "z",
                                       "xy",
                                       "xz",
                                       "xyz",
                                       "front",
                                       "back",
                                       "left",
                                       "right",
                                       "top",
                                       "bottom",
                                       "side",
                                       "vertical",
                                       "horizontal",
                                       "aslant",
                                       "nutant",
                                       "all",
                                       "object.front",
                                       "world.up",
                                       "world.south",
                                       "street.front",
                                       "roof.top",
                                       "eave",
                                       "hip",
                                       "valley",
                                       "ridge",
                                       "f",
                                       "e",
                                       "v",
                                       "fe",
                                       "g",
                                       "byAngle",
                                       "byHeight",
                                       "byPositiveHeight",
                                       "world.up",
                                       "rel",
                                       "abs",
                                       "'0.5",
                                       "~1",
                                       "'1",
                                       "~0",
                                       "*",
                                       "noAdjust",
                                       "unitSpace",
                                       "attr",
                                       "const",
                                       "import",
                                       "style",
                                       "extends",
                                       "version",
                                       "case",
                                       "else",
                                       "-->",
                                       "=",
                                       "%",
                                       ":",
                                       "|",
                                       "{",
                                       "}",
                                       "*",
                                       "@StartRule",
                                       "@Range(min=0, max=1)",
                                       "@Group(\"a\", 1)",
                                       "true",
                                       "false",
                                       "&&",
                                       "||",
                                       "==",
                                       "!=",
                                       "<",
                                       ">",
                                       "?",
                                       "[",
                                       "]",
                                       ";",
                                       "\n",
                                       "/*",
                                       "*/",
                                       "//",
                                       "#"};

constexpr std::string_view kImported =
    "version \"2021.0\"\nattr height = 7\nconst third = height / 3\n"
    "twice(x) = 2 * x\nMass --> extrude(twice(height)) comp(f) { side : Wall | all : X. }\n"
    "Wall --> split(y) { ~third : Floor. }*\nstyle Low\nattr height = 3\n";

Footprint footprintOf(Ring2 outer, std::vector<Ring2> holes, double height)
{
    Footprint footprint;
    footprint.id = std::string(1, 'b');
    const size_t edges = outer.size();
    size_t all = edges;
    for (const Ring2& hole : holes) all += hole.size();
    footprint.outline = {std::move(outer), std::move(holes)};
    footprint.height = height;
    footprint.covered.resize(all);
    footprint.covered[1] = {{0.0, 4.0, 0.6 * height}, {4.0, 5.0, height}};
    footprint.onStreet.assign(edges, false);
    footprint.onStreet[0] = true;
    footprint.attributes["height"] = height;
    footprint.attributes["use"] = std::string("shop");
    return footprint;
}

GivenFace faceOf(Ring3 ring, GivenKind kind)
{
    return {{std::move(ring), {}}, kind};
}

const std::vector<Footprint>& footprints()
{
    static const std::vector<Footprint> all = [] {
        std::vector<Footprint> result;
        result.push_back(footprintOf({{0, 0}, {10, 0}, {10, 6}, {0, 6}}, {}, 9.0));
        result.push_back(footprintOf({{0, 0}, {12, 0}, {12, 5}, {5, 5}, {5, 11}, {0, 11}}, {}, 14.0));
        result.push_back(
            footprintOf({{0, 0}, {20, 1}, {19, 17}, {1, 15}}, {{{6, 5}, {6, 10}, {13, 11}, {14, 6}}}, 12.0));
        result.push_back(footprintOf({{0, 0}, {9, 0}, {3, 7}}, {}, 3.0));
        result.push_back(footprintOf({{0, 0}, {30, 0}, {30, 0.3}, {0, 0.31}}, {}, 0.5));
        Footprint given = footprintOf({{0, 0}, {8, 0}, {8, 6}, {0, 6}}, {}, 8.0);
        given.faces = {faceOf({{0, 0, 0}, {8, 0, 0}, {8, 0, 5}, {0, 0, 5}}, GivenKind::Wall),
                       faceOf({{8, 0, 0}, {8, 6, 0}, {8, 6, 5}, {8, 3, 8}, {8, 0, 5}}, GivenKind::Wall),
                       faceOf({{8, 6, 0}, {0, 6, 0}, {0, 6, 5}, {8, 6, 5}}, GivenKind::Wall),
                       faceOf({{0, 6, 0}, {0, 0, 0}, {0, 0, 5}, {0, 3, 8}, {0, 6, 5}}, GivenKind::Wall),
                       faceOf({{0, 0, 5}, {8, 0, 5}, {8, 3, 8}, {0, 3, 8}}, GivenKind::Roof),
                       faceOf({{0, 6, 5}, {0, 3, 8}, {8, 3, 8}, {8, 6, 5}}, GivenKind::Roof)};
        result.push_back(given);
        return result;
    }();
    return all;
}

bool isFinite(const Polygon3& polygon)
{
    const auto good = [](const Ring3& ring) {
        for (const glm::dvec3& corner : ring)
            if (!std::isfinite(corner.x + corner.y + corner.z)) return false;
        return ring.size() >= 3;
    };
    for (const Ring3& hole : polygon.holes)
        if (!good(hole)) return false;
    return good(polygon.outer);
}

} // namespace

const TextTarget textTarget = {"rules", kWords};
u64 acceptedTexts = 0, refusedTexts = 0;

} // namespace helio::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, size_t size)
{
    using namespace helio;
    using namespace helio::fuzz;
    const std::string_view text(reinterpret_cast<const char*>(data), size);
    RuleOptions ruleOptions;
    ruleOptions.readImport = [&](const std::string& path) -> Result<std::string> {
        if (path.size() > 40) return Error{"no such file"};
        // A file that imports itself is one of the traps.
        return path.find("self") == std::string::npos ? std::string(kImported) : std::string(text);
    };
    const Result<RuleSet> rules = parseRules(text, "fuzz.cga", ruleOptions);
    if (!rules) {
        HELIO_CHECK(!rules.error().message.empty(), size);
        ++refusedTexts;
        return 0;
    }
    (void)explainRules(*rules);
    DeriveOptions options;
    options.jobs = 1;
    options.maxSteps = kMaxSteps;
    options.assetBox = [](const std::string& name) -> Result<AssetBox> {
        if (name.starts_with("missing")) return Error{"no such asset"};
        return AssetBox{{0, 0, 0}, {1, 1, name.size() % 2 == 0 ? 1.0 : 0.0}};
    };
    bool accepted = false;
    for (const Footprint& footprint : footprints()) {
        const Result<Derivation> derivation = derive(*rules, std::span(&footprint, 1), options);
        if (!derivation) {
            HELIO_CHECK(!derivation.error().message.empty(), size);
            continue;
        }
        accepted = true;
        for (const Polygon3& polygon : derivation->shapes.polygons) HELIO_CHECK(isFinite(polygon), size);
        std::vector<AssetSummary> assets(derivation->shapes.assets.size());
        const NodeTreeBuild build = buildNodes(derivation->shapes, assets);
        HELIO_CHECK(std::isfinite(build.areaDefect), size);
    }
    ++(accepted ? acceptedTexts : refusedTexts);
    return 0;
}
