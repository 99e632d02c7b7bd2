// SPDX-License-Identifier: Apache-2.0
// A pack with good checksums and bad values: every rule refuses its own fault and names section and byte.
#include <cmath>
#include <functional>
#include <gtest/gtest.h>

#include "city/format/validate.h"
#include "tests/unit/pack_sample.h"

namespace helio {
namespace {

const float kNan = std::nanf("");

struct Fault
{
    const char* name;
    std::function<void(PackContent&)> make;
    const char* message; ///< with the byte where the element starts
};

std::string check(const PackContent& content)
{
    SectionPlaces places;
    places.file = "T";
    const Status status = validateTile(content.view(), content.index, places);
    return status ? "" : status.error().message;
}

TEST(PackValidate, TheSampleIsGood)
{
    EXPECT_EQ(check(test::samplePack()), "");
}

TEST(PackValidate, EveryFaultIsNamed)
{
    using C = PackContent;
    const std::vector<Fault> faults = {
        {"name", [](C& c) { c.nodeNames.pop_back(); }, "section node names, byte 17: the last name does not end"},
        {"no patches", [](C& c) { c.patches.clear(); }, "section patches, byte 0: there are no patches"},
        {"few nodes", [](C& c) { c.nodes.resize(2); }, "section nodes, byte 0: 2 nodes for 3 patches"},
        {"area", [](C& c) { c.patches[1].area = 0; }, "section patches, byte 64: patch 1: area 0 m2"},
        {"area nan", [](C& c) { c.patches[1].area = kNan; }, "section patches, byte 64: patch 1: area nan"},
        {"area inf", [](C& c) { c.patches[1].area = INFINITY; }, "section patches, byte 64: patch 1: area inf"},
        {"normal", [](C& c) { c.patches[0].normal.x = 1; }, "section patches, byte 0: patch 0: the normal"},
        {"rho", [](C& c) { c.patches[2].rho.w = 1.5f; }, "section patches, byte 128: patch 2: reflectance 1.5"},
        {"rho nan", [](C& c) { c.patches[2].rho.x = kNan; }, "section patches, byte 128: patch 2: reflectance nan"},
        {"emission", [](C& c) { c.patches[2].emission.y = -1; }, "section patches, byte 128: patch 2: emission -1"},
        {"building", [](C& c) { c.patches[0].building = 1; }, "section patches, byte 0: patch 0: building 1 of 1"},
        {"surface", [](C& c) { c.patches[0].surface = 2; }, "section patches, byte 0: patch 0: surface 2 of 2"},
        {"face", [](C& c) { c.patches[0].sourceFace = 3; }, "section patches, byte 0: patch 0: source face 3 of 3"},
        {"infos", [](C& c) { c.nodeInfos.pop_back(); }, "section node infos, byte 0: 4 records for 5 nodes"},
        {"leaf area", [](C& c) { c.nodes[0].area = 1.5f; }, "section nodes, byte 0: node 0: its area differs"},
        {"node area", [](C& c) { c.nodes[3].area = -2; }, "section nodes, byte 48: node 3: area -2"},
        {"area sum", [](C& c) { c.nodes[3].area = 2.1f; },
         "section nodes, byte 48: node 3: area 2.1 m2, its children's is 2"},
        {"leaf child", [](C& c) { c.nodes[0].childCount = 1; }, "section nodes, byte 0: node 0: 1 children of a leaf"},
        {"no child", [](C& c) { c.nodes[4].childCount = 0; }, "section nodes, byte 64: node 4: 0 children of an inner"},
        {"children", [](C& c) { c.nodes[4].childCount = 3; }, "section nodes, byte 64: node 4: children 2 + 3 of 4"},
        {"children wrap", [](C& c) { c.nodes[4].childBegin = 0xFFFFFFFF; }, "section nodes, byte 64: node 4: children"},
        {"parent low", [](C& c) { c.nodes[3].parent = 2; }, "section nodes, byte 48: node 3: parent 2 does not come"},
        {"parent high", [](C& c) { c.nodes[3].parent = 5; }, "section nodes, byte 48: node 3: parent 5 does not come"},
        {"leaf height", [](C& c) { c.nodeInfos[0].height = 1; },
         "section node infos, byte 0: node 0: height 1 of a leaf"},
        {"order", [](C& c) { c.nodeInfos[3].height = 3; }, "section node infos, byte 192: node 4: lies lower"},
        {"height", [](C& c) { c.nodeInfos[4].height = 3; },
         "section node infos, byte 192: node 4: height 3, its children say 2"},
        {"kind", [](C& c) { c.nodeInfos[4].kind = 3; }, "section node infos, byte 192: node 4: kind 3"},
        {"centroid", [](C& c) { c.nodeInfos[4].centroid.z = kNan; },
         "section node infos, byte 192: node 4: the centroid"},
        {"flat cluster", [](C& c) { c.nodeInfos[3].normal = glm::vec3(0); },
         "section node infos, byte 144: node 3: the normal"},
        {"coverage", [](C& c) { c.nodeInfos[3].coverage = -1; }, "section node infos, byte 144: node 3: coverage -1"},
        {"info building", [](C& c) { c.nodeInfos[3].building = 9; },
         "section node infos, byte 144: node 3: building 9 of 1"},
        {"info name", [](C& c) { c.nodeInfos[3].name = 3; }, "section node infos, byte 144: node 3: name 3 of 3"},
        {"child index", [](C& c) { c.children[2] = 5; },
         "section children, byte 8: child 5 of node 4: there are 5 nodes"},
        {"child of other", [](C& c) { c.children[2] = 0; },
         "section children, byte 8: child 0 of node 4: its parent is 3"},
        {"child twice", [](C& c) { c.children[1] = 0; },
         "section children, byte 4: child 0 of node 3: it is listed twice"},
        {"unlisted", [](C& c) { c.nodes[4].childCount = 1, c.nodes[4].area = 2.0f; },
         "section nodes, byte 32: node 2: its parent 4 does not list it"},
        {"error count", [](C& c) { c.patchErrors.pop_back(); }, "section patch errors, byte 0: 2 errors for 3 patches"},
        {"error", [](C& c) { c.patchErrors[1] = kNan; }, "section patch errors, byte 4: error nan of patch 1"},
        {"error below 0", [](C& c) { c.patchErrors[2] = -1; }, "section patch errors, byte 8: error -1 of patch 2"},
        {"row count", [](C& c) { c.linkRows.pop_back(); }, "section link rows, byte 0: 5 offsets for 5 rows"},
        {"row first", [](C& c) { c.linkRows[0] = 1; }, "section link rows, byte 0: the first row starts at 1"},
        {"row falls", [](C& c) { c.linkRows[2] = 5; }, "section link rows, byte 12: row 3 starts before row 2"},
        {"row end", [](C& c) { c.linkRows[5] = 5; }, "section link rows, byte 20: the rows end at 5 of 4"},
        {"column", [](C& c) { c.linkColumns[3] = 5; }, "section link columns, byte 12: row 2 refers to column 5 of 5"},
        {"column order", [](C& c) { c.linkColumns[2] = 1; },
         "section link columns, byte 12: the columns of row 2 do not rise"},
        {"factor count", [](C& c) { c.linkFactors.pop_back(); },
         "section link factors, byte 0: 3 factors for 4 columns"},
        {"factor", [](C& c) { c.linkFactors[1] = 1.001f; }, "section link factors, byte 4: factor 1.001 in row 1"},
        {"factor negative", [](C& c) { c.linkFactors[1] = -1e-6f; },
         "section link factors, byte 4: factor -1e-06 in row 1"},
        {"factor nan", [](C& c) { c.linkFactors[1] = kNan; }, "section link factors, byte 4: factor nan in row 1"},
        {"moments", [](C& c) { c.linkMoments.pop_back(); }, "section link moments, byte 0: 7 moments for 4 links"},
        {"moment", [](C& c) { c.linkMoments[3] = INFINITY; }, "section link moments, byte 12: a moment is not finite"},
        {"sky patch", [](C& c) { c.skyPatches[0].solidAngle = 0; }, "section sky patches, byte 0: sky patch 0"},
        {"sky offsets",
         [](C& c) {
             c.skyOffsets = {1, 2};
         },
         "section sky offsets, byte 0: 2 offsets for 3 sky links"},
        {"sky that reflects", [](C& c) { c.skyPatches[0].rho.z = 0.1f; },
         "section sky patches, byte 0: sky patch 0: reflectance 0.1"},
        {"far ground that shines",
         [](C& c) {
             c.skyPatches.push_back({{0, 0, -1}, 6.28f, glm::vec4(1.5f)});
         },
         "section sky patches, byte 32: sky patch 1: reflectance 1.5"},
        {"far ground before sky",
         [](C& c) {
             c.skyPatches.insert(c.skyPatches.begin(), {{0, 0, -1}, 6.28f, {}});
         },
         "section sky patches, byte 0: sky patch 0 lies below the horizon and is not the last"},
        {"sky rows", [](C& c) { c.skyRows.push_back(3); }, "section sky rows, byte 0: 5 offsets for 3 rows"},
        {"sky column", [](C& c) { c.skyColumns[1] = 1; }, "section sky columns, byte 4: row 1 refers to column 1 of 1"},
        {"sky factor", [](C& c) { c.skyFactors[2] = 2; }, "section sky factors, byte 8: factor 2 in row 2"},
        {"no rings", [](C& c) { c.outlineRings.clear(); }, "section outline rings, byte 0: the last entry is missing"},
        {"ring start", [](C& c) { c.outlineRings[0] = 2; },
         "section outline rings, byte 0: the first ring starts at 1"},
        {"thin ring", [](C& c) { c.outlineRings[2] = 6 << 1; },
         "section outline rings, byte 8: ring 1 has less than 3"},
        {"ring wraps", [](C& c) { c.outlineRings[2] = 0xFFFFFFFE; },
         "section outline rings, byte 12: ring 2 has less than 3"},
        {"ring end", [](C& c) { c.outlineRings[5] = 21 << 1; }, "section outline rings, byte 20: the rings do not end"},
        {"rests", [](C& c) { c.outlineRests.pop_back(); }, "section outline rests, byte 0: 19 rests of 20 points"},
        {"point", [](C& c) { c.outlinePoints[2].y = kNan; }, "section outline points, byte 24: a corner is not finite"},
        {"no outline", [](C& c) { c.outlineRows[1] = 0; }, "section outline rows, byte 0: patch 0 has no outline"},
        {"hole first", [](C& c) { c.outlineRings[1] |= 1; }, "section outline rows, byte 4: patch 1 has no outline"},
        {"vertex", [](C& c) { c.vertices[8].position.x = kNan; }, "section vertices, byte 192: vertex 8 is not finite"},
        {"no instance", [](C& c) { c.instances.clear(); },
         "section instances, byte 0: the static mesh's instance is missing"},
        {"matrix", [](C& c) { c.instances[1].worldFromLocal[2].w = kNan; },
         "section instances, byte 64: the matrix of instance 1"},
        {"draw triangle", [](C& c) { c.draws[0].indexCount = 5; }, "section draws, byte 0: draw 0: indices 0 + 5 of 9"},
        {"draw indices", [](C& c) { c.draws[1].indexCount = 6; }, "section draws, byte 20: draw 1: indices 6 + 6 of 9"},
        {"draw wraps", [](C& c) { c.draws[1].firstIndex = 0xFFFFFFFE; }, "section draws, byte 20: draw 1: indices"},
        {"draw instances", [](C& c) { c.draws[1].instanceCount = 3; },
         "section draws, byte 20: draw 1: instances 1 + 3 of 3"},
        {"index", [](C& c) { c.indices[8] = 3; }, "section indices, byte 32: draw 1 refers to vertex 9 of 9"},
        {"vertex offset", [](C& c) { c.draws[1].vertexOffset = 0xFFFFFFFF; },
         "section indices, byte 24: draw 1 refers to vertex 4294967295"},
        {"vertex patch", [](C& c) { c.vertices[4].patchId = 3; }, "section draws, byte 0: draw 0: patch 3 of 3"},
        {"instance patch", [](C& c) { c.instances[2].patchId = 3; }, "section draws, byte 20: draw 1: patch 3 of 3"},
        {"patch sum", [](C& c) { c.vertices[6].patchId = 2; }, "section draws, byte 20: draw 1: patch 3 of 3"},
    };
    for (const Fault& fault : faults) {
        PackContent content = test::samplePack();
        fault.make(content);
        const std::string message = check(content);
        EXPECT_EQ(message.rfind(concat("T: ", fault.message), 0), 0u)
            << fault.name << ": '" << message << "', not '" << fault.message << "'";
    }
}

} // namespace
} // namespace helio
