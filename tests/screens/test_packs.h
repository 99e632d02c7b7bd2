// SPDX-License-Identifier: Apache-2.0
// The packs and the device that the picture tests share within one process.
#pragma once
#include <filesystem>

#include "city/base/result.h"
#include "city/format/pack.h"
#include "engine/gpu/context.h"
#include "engine/view/renderer.h"

namespace helio {

enum class TestPack
{
    City,     ///< tests/screens/data/small_city.geojson with the shipped rules
    SceneS,   ///< tests/data/scenes/S.obj
    Midrise,  ///< a box, an L, a courtyard and a triangle with midrise.cga
    Rowhouse, ///< the same, smaller, with rowhouse.cga
    Tower     ///< the same, larger, with tower.cga
};

/// Bakes all packs anew into the build folder. ctest does it once, before the tests that need them.
Status bakeTestPacks();

/// Folder of a pack; bakes it first if it is not there (a test that was started by hand).
std::filesystem::path testPackFolder(TestPack which);

/// The pack, the software device and a renderer of the pack; made at the first call, ended with the process. What is
/// missing ends the process with its sentence.
const Pack& testPack(TestPack which);
Context& testContext();
Renderer& testRenderer(TestPack which);

} // namespace helio
