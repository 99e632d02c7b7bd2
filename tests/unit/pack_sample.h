// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/pack/content.h"

namespace helio::test {

/// A small pack written out by hand. Patches 0 and 1 tile a wall of 2 x 1 m (planar node 3), patch 2 is a square metre
/// of ground with a square hole of 0.25 m2; node 4, a cluster, holds them all. Patch 1 is drawn by an asset, twice.
inline PackContent samplePack()
{
    const glm::vec3 south(0, -1, 0), up(0, 0, 1);
    const glm::vec4 grey(0.5f, 0.4f, 0.3f, 0.45f), lamp(0.0f, 1.0f, 2.0f, 0.0f);
    PackContent c;
    c.index.crs = "EPSG:28992";
    c.index.origin = {91000.125, 436000.5, -1.0};
    c.index.latitudeDeg = 51.9;
    c.index.longitudeDeg = 4.45;
    c.index.northDeg = -0.75;
    c.index.source = "made by hand";
    c.index.rules = "none.cga";
    c.index.method = "heliopolis";
    c.index.inputHash = 0xFEDCBA9876543210ull;
    c.index.rulesHash = 7;
    c.index.seed = 0xFFFFFFFFFFFFFFFFull;
    c.index.options = R"({"rays":16})";
    c.index.sourceFaceCount = 3;
    c.index.boundsMin = {0, 0, 0};
    c.index.boundsMax = {2, 1, 1};
    c.patches = {{south, 1.0f, grey, glm::vec4(0), 0, 0, 0, 0},
                 {south, 1.0f, grey, lamp, 0, 1, gpu::kNone, 0},
                 {up, 0.75f, grey, glm::vec4(0), gpu::kNone, gpu::kNone, 1, 0}};
    c.nodes = {{3, 0, 0, 1.0f}, {3, 0, 0, 1.0f}, {4, 0, 0, 0.75f}, {4, 0, 2, 2.0f}, {gpu::kNone, 2, 2, 2.75f}};
    c.nodeInfos = {{{0.5f, 0, 0.5f}, 0, south, 0, 1.0f, 0, 1, 0},
                   {{1.5f, 0, 0.5f}, 0, south, 0, 1.0f, 0, 1, 0},
                   {{1.5f, 0.5f, 0}, 0, up, 0, 1.0f, gpu::kNone, 2, 0},
                   {{1.0f, 0, 0.5f}, 1, south, 0, 1.0f, 0, 0, 0},
                   {{1.1f, 0.1f, 0.4f}, 2, glm::vec3(0), 2, 0.0f, gpu::kNone, 0, 0}};
    c.children = {0, 1, 3, 2};
    c.outlineRows = {0, 1, 2, 4, 5, 5};
    c.outlineRings = {0 << 1, 4 << 1, 8 << 1, 12 << 1 | 1, 16 << 1, 20 << 1};
    c.outlinePoints = {{0, 0, 0},         {1, 0, 0}, {1, 0, 1},         {0, 0, 1},         {1, 0, 0},
                       {2, 0, 0},         {2, 0, 1}, {1, 0, 1},         {1, 0, 0},         {2, 0, 0},
                       {2, 1, 0},         {1, 1, 0}, {1.25f, 0.25f, 0}, {1.25f, 0.75f, 0}, {1.75f, 0.75f, 0},
                       {1.75f, 0.25f, 0}, {0, 0, 0}, {2, 0, 0},         {2, 0, 1},         {0, 0, 1}};
    c.outlineRests.assign(c.outlinePoints.size(), glm::vec3(1e-9f, 0, 0));
    c.linkRows = {0, 1, 2, 4, 4, 4};
    c.linkColumns = {2, 2, 0, 1};
    c.linkFactors = {0.1f, 0.2f, 0.15f, 0.25f};
    c.linkMoments = {0, 0.01f, 0, 0.02f, -0.01f, 0, 0, 0};
    c.childSlopes = {{-1, 0, 0, 0, 0, 0}, {1, 0, 0, 0, 0, 0}, {}, {}};
    c.skyPatches = {{up, 6.2831853f, {}}};
    c.skyRows = {0, 1, 2, 3};
    c.skyColumns = {0, 0, 0};
    c.skyFactors = {0.5f, 0.5f, 0.6f};
    c.patchErrors = {0.01f, 0.02f, 0.5f};
    c.vertices = {{{0, 0, 0}, 0, 0, 0xFF000000u}, {{1, 0, 0}, 0, 0, 0xFF000000u}, {{1, 0, 1}, 0, 0, 0xFF000000u},
                  {{1, 1, 0}, 2, 0, 0xFF000000u}, {{2, 1, 0}, 2, 0, 0xFF000000u}, {{2, 0, 0}, 2, 0, 0xFF000000u},
                  {{0, 0, 0}, 0, 5, 0xFFFFFFFFu}, {{1, 0, 0}, 0, 5, 0xFFFFFFFFu}, {{0, 1, 0}, 0, 5, 0xFFFFFFFFu}};
    c.indices = {0, 1, 2, 3, 5, 4, 0, 1, 2};
    const gpu::InstanceRecord identity{{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}}, 0, 0, 0, 0};
    gpu::InstanceRecord moved = identity;
    moved.patchId = 1;
    moved.worldFromLocal[0].w = 1.0f;
    c.instances = {identity, moved, moved};
    c.draws = {{6, 1, 0, 0, 0}, {3, 2, 6, 6, 1}};
    c.nodeNames = "Facade\nWall\nGround\n";
    c.surfaceNames = "brick\nstreet\n";
    c.buildingIds = "house 1\n";
    return c;
}

/// The same with so many links that their compact form is the smaller one in all three sections.
inline PackContent linkedPack()
{
    PackContent c = samplePack();
    c.linkRows = {0, 3, 6, 9, 9, 9};
    c.linkColumns = {1, 2, 3, 0, 2, 3, 0, 1, 3};
    c.linkFactors = {0.01f, 0.1f, 0.05f, 0.02f, 0.2f, 0.001f, 0.15f, 0.25f, 0.3f};
    c.linkMoments = {0, 0, 0, 0, 0.05f, 0, 0, 0, 0, 0, -0.0005f, 0, 0, 0, 0, 0, 0.01f, 0};
    return c;
}

} // namespace helio::test
