// SPDX-License-Identifier: Apache-2.0
// Loading of the shipped facade parts, and of files that are damaged.
#include "city/assets/asset.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <glm/geometric.hpp>

#include "city/base/file.h"
#include "city/base/hash.h"

namespace helio {
namespace {

const std::filesystem::path kFolder = HELIO_ASSETS_DIR;

AssetMesh mustLoad(const std::string& name)
{
    auto mesh = loadAsset(kFolder / name, name);
    EXPECT_TRUE(mesh.ok()) << (mesh.ok() ? "" : mesh.error().message);
    return mesh.ok() ? std::move(*mesh) : AssetMesh{};
}

/// A .glb around a JSON text and a binary chunk.
std::string glb(std::string json, std::string binary)
{
    json.resize((json.size() + 3) / 4 * 4, ' ');
    binary.resize((binary.size() + 3) / 4 * 4, '\0');
    std::string file;
    const auto add = [&](u32 value) { file.append(reinterpret_cast<const char*>(&value), 4); };
    file += "glTF";
    add(2);
    add(u32(12 + 8 + json.size() + 8 + binary.size()));
    add(u32(json.size()));
    file += "JSON" + json;
    add(u32(binary.size()));
    file += std::string("BIN\0", 4) + binary;
    return file;
}

Result<AssetMesh> parse(const std::string& bytes)
{
    return parseAsset(std::as_bytes(std::span(bytes)), "t.glb", "t.glb");
}

/// One triangle of 2 x 2 in the plane z = 1 that looks to +z; `accessor` and `node` are spliced into the JSON.
std::string triangle(const std::string& accessor = R"("count":3)", const std::string& node = "",
                     const std::string& material = R"("name":"glass")", const std::string& top = "")
{
    const float corners[9] = {0, 0, 1, 2, 0, 1, 0, 2, 1};
    const std::string json =
        R"({"asset":{"version":"2.0"},)" + top + R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"n","mesh":0)" +
        node + R"(}],"meshes":[{"primitives":[{"attributes":{"POSITION":0},"material":0}]}],"materials":[{)" +
        material +
        R"(}],"accessors":[{"bufferView":0,"componentType":5126,"type":"VEC3","min":[0,0,1],"max":[2,2,1],)" +
        accessor + R"(}],"bufferViews":[{"buffer":0,"byteOffset":0,"byteLength":36}],"buffers":[{"byteLength":36}]})";
    return glb(json, std::string(reinterpret_cast<const char*>(corners), sizeof corners));
}

TEST(Assets, ShippedPartsLoad)
{
    // Sizes and triangle counts as make_assets.py defines the parts: a sill is one box of 1.4 x 0.08 x 0.12 m.
    const AssetMesh sill = mustLoad("facade/sill.glb");
    EXPECT_EQ(sill.indices.size(), 36u);
    EXPECT_EQ(sill.path, "facade/sill.glb");
    EXPECT_NEAR(glm::distance(sill.boxMin, glm::dvec3(0)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(sill.boxMax, glm::dvec3(1.4, 0.08, 0.12)), 0, 1e-6);
    const AssetMesh window = mustLoad("facade/window_sash.glb");
    EXPECT_NEAR(glm::distance(window.boxMax, glm::dvec3(1.25, 2.2, 0.28)), 0, 1e-6);
    const AssetMesh balcony = mustLoad("facade/balcony_iron.glb");
    EXPECT_NEAR(balcony.boxMin.y, -0.3, 1e-6);
    size_t triangles = 0, count = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kFolder / "facade")) {
        const AssetMesh mesh = mustLoad("facade/" + entry.path().filename().string());
        triangles += mesh.indices.size() / 3;
        ++count;
        ASSERT_EQ(mesh.normals.size(), mesh.positions.size());
        ASSERT_EQ(mesh.albedos.size(), mesh.positions.size());
        ASSERT_EQ(mesh.isGlass.size(), mesh.positions.size());
        for (size_t t = 0; t < mesh.indices.size(); t += 3) { // closed boxes: normals agree with the winding
            const u32* v = &mesh.indices[t];
            const glm::vec3 n =
                glm::cross(mesh.positions[v[1]] - mesh.positions[v[0]], mesh.positions[v[2]] - mesh.positions[v[0]]);
            EXPECT_GT(glm::dot(glm::normalize(n), mesh.normals[v[0]]), 0.99f) << entry.path();
        }
        for (int k = 0; k < 4; ++k) {
            EXPECT_GE(mesh.rho[k], 0.0);
            EXPECT_LE(mesh.rho[k], 0.95);
        }
    }
    EXPECT_EQ(count, 18u);
    EXPECT_EQ(triangles, 2252u);
}

TEST(Assets, ReflectanceGoesByWhatTheFrontShows)
{
    // The panel's frame of 5 cm around 1.5 x 3 m of alu, glass (0.12) inside: glass share 1.4 x 2.9 / 4.5, on a grid of
    // 128 x 128.
    const AssetMesh panel = mustLoad("facade/curtain_panel.glb");
    const double glass = 1.4 * 2.9 / 4.5;
    EXPECT_NEAR(panel.rho.a, glass * 0.12 + (1 - glass) * 0.46, 0.01);
    EXPECT_NEAR(parse(triangle())->rho.a, 0.12, 1e-12); // by name, not by the white display colour
    const auto unknown = parse(
        triangle(R"("count":3)", "", R"("name":"mystery","pbrMetallicRoughness":{"baseColorFactor":[1,0.5,0,1]})"));
    EXPECT_NEAR(unknown->rho.a, 0.2126 + 0.7152 * 0.5, 1e-12);
    EXPECT_NEAR(unknown->albedos[0].g, 0.5, 1e-6);
    EXPECT_FALSE(unknown->isGlass[0]);
    EXPECT_TRUE(parse(triangle())->isGlass[0]) << "by name, too";
    EXPECT_EQ(std::count(panel.isGlass.begin(), panel.isGlass.end(), true), 24) << "one pane, a box";
}

TEST(Assets, NodesArePlaced)
{
    const auto moved = parse(triangle(R"("count":3)", R"(,"translation":[10,0,0],"scale":[2,1,1])"));
    ASSERT_TRUE(moved.ok()) << moved.error().message;
    EXPECT_NEAR(glm::distance(moved->boxMin, glm::dvec3(10, 0, 1)), 0, 1e-6);
    EXPECT_NEAR(glm::distance(moved->boxMax, glm::dvec3(14, 2, 1)), 0, 1e-6);
    EXPECT_NEAR(moved->normals[0].z, 1, 1e-6); // made from the triangle, as the file has none
    // A quarter turn about y takes +z to +x.
    const auto turned = parse(triangle(R"("count":3)", R"(,"rotation":[0,0.70710678,0,0.70710678])"));
    EXPECT_NEAR(turned->normals[0].x, 1, 1e-6);
    const auto mirrored = parse(triangle(R"("count":3)", R"(,"scale":[-1,1,1])"));
    EXPECT_NEAR(mirrored->normals[0].z, 1, 1e-6); // still looks to +z
}

TEST(Assets, FaultsAreNamed)
{
    const auto says = [](const std::string& bytes, const std::string& part) {
        const auto mesh = parse(bytes);
        ASSERT_FALSE(mesh.ok()) << part;
        EXPECT_EQ(mesh.error().message.rfind("t.glb: cannot be used as an asset: ", 0), 0u) << mesh.error().message;
        EXPECT_NE(mesh.error().message.find(part), std::string::npos) << mesh.error().message;
        EXPECT_EQ(mesh.error().message.find('\n'), std::string::npos);
    };
    says("", "not a binary glTF");
    says("hello, this is no glTF file at all", "not a binary glTF");
    says(triangle(R"("count":300)"), "past the end");
    says(triangle(R"("count":3,"byteOffset":8)"), "past the end");
    says(triangle(R"("count":2)"), "whole number of triangles");
    says(triangle(R"("count":3)", R"(,"children":[0])"), "circle");
    says(triangle(R"("count":3)", R"(,"translation":[1e300,0,0])"), "not finite");
    says(triangle(
             R"("count":3)", "", R"("name":"x")",
             R"("extensionsRequired":["KHR_draco_mesh_compression"],"extensionsUsed":["KHR_draco_mesh_compression"],)"),
         "KHR_draco_mesh_compression");
    says(glb(R"({"asset":{"version":"2.0"}})", "0000"), "no triangle mesh");
    // Each node has the next one as child twice: 2^31 ways lead through the scene.
    std::string nodes = "{}";
    for (int k = 31; k-- > 0;) nodes = concat(R"({"children":[)", k + 1, ",", k + 1, "]},", nodes);
    says(glb(R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[)" + nodes + "]}", "0000"),
         "more than 100000 nodes");
    EXPECT_FALSE(loadAsset(kFolder / "missing.glb", "missing.glb").ok());
}

// Damaged files: every short prefix, and thousands of random byte changes. Whatever comes back, it must be consistent.
TEST(Assets, DamagedFilesDoNotCrash)
{
    const auto file = readTextFile(kFolder / "facade/sill.glb");
    ASSERT_TRUE(file.ok());
    Random random(3);
    const auto check = [](const std::string& bytes) {
        const auto mesh = parse(bytes);
        if (!mesh.ok()) return;
        for (const u32 index : mesh->indices) ASSERT_LT(index, mesh->positions.size());
        for (const glm::vec3& p : mesh->positions)
            ASSERT_TRUE(std::isfinite(p.x) && std::isfinite(p.y) && std::isfinite(p.z));
    };
    for (size_t length = 0; length < file->size(); length += 7) check(file->substr(0, length));
    for (int round = 0; round < 3000; ++round) {
        std::string bytes = *file;
        for (int k = 0; k < 1 + round % 4; ++k) {
            // Digits of the JSON are the offsets, counts and indices: change them to other digits most of the time.
            const size_t at = size_t(random.uniform() * double(bytes.size()));
            const bool digit = bytes[at] >= '0' && bytes[at] <= '9';
            bytes[at] = digit ? char('0' + int(random.uniform() * 10)) : char(random.next() & 0xFF);
        }
        check(bytes);
    }
}

TEST(Assets, NamesAreLookedUpInFolders)
{
    const auto found = findAsset("facade/sill.glb", {"/nowhere", kFolder});
    ASSERT_TRUE(found.ok());
    EXPECT_EQ(*found, kFolder / "facade/sill.glb");
    const auto missing = findAsset("facade/none.glb", {"/nowhere", kFolder});
    ASSERT_FALSE(missing.ok());
    EXPECT_NE(missing.error().message.find("/nowhere/facade/none.glb"), std::string::npos);
    EXPECT_FALSE(findAsset("../facade/sill.glb", {kFolder / "facade"}).ok());
    EXPECT_FALSE(findAsset("/etc/passwd", {kFolder}).ok());
    EXPECT_FALSE(findAsset("", {kFolder}).ok());
}

} // namespace
} // namespace helio
