// SPDX-License-Identifier: Apache-2.0
#include "city/layout/surfaces.h"

#include <gtest/gtest.h>

#include <fstream>

using namespace helio;

namespace {

constexpr const char* kHeader = "quad_id,kind,building,facade,floor,bay,rho_r,rho_g,rho_b,emit_r,emit_g,emit_b\n";
constexpr const char* kSquare = "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\n";

class Surfaces : public testing::Test
{
protected:
    Result<ShapeTree> read(const std::string& obj, const std::string& csv)
    {
        const std::filesystem::path folder = testing::TempDir();
        const std::string name = std::string("helio_") + testing::UnitTest::GetInstance()->current_test_info()->name();
        objPath_ = folder / (name + ".obj");
        csvPath_ = folder / (name + ".csv");
        std::ofstream(objPath_) << obj;
        std::ofstream(csvPath_) << csv;
        return readSurfaces(objPath_, csvPath_);
    }
    // The message without the path: "obj:7: ..." or "csv:2: ...".
    std::string errorOf(const std::string& obj, const std::string& csv)
    {
        const Result<ShapeTree> tree = read(obj, csv);
        EXPECT_FALSE(tree.ok());
        if (tree.ok()) return "";
        std::string message = tree.error().message;
        EXPECT_EQ(message.find('\n'), std::string::npos);
        for (const auto& [path, word] : {std::pair(objPath_.string(), "obj"), std::pair(csvPath_.string(), "csv")})
            if (message.starts_with(path)) return word + message.substr(path.size());
        ADD_FAILURE() << "names no file: " << message;
        return message;
    }
    void TearDown() override
    {
        std::filesystem::remove(objPath_);
        std::filesystem::remove(csvPath_);
    }

    std::filesystem::path objPath_, csvPath_;
};

TEST_F(Surfaces, MakeATreeInOrderOfAppearance)
{
    const std::string obj = std::string("# a comment\r\no house\ng wall\nusemtl stone\n") + kSquare +
                            "f -4 -3 -2 -1\n"
                            "vt 0 0\nvn 0 0 1\n"
                            "f 1/1/1 2/1/1 3/1/1\n"
                            "f 1//1 3//1 4//1\n"
                            "v 5 0 0\nv 9 0 0\nv 9 4 0\nv 7 1 0\n" // concave
                            "f 5 6 7 8\n";
    const std::string csv = std::string(kHeader) + "0,wall,4,0,0,0,.5,.4,.3,0,0,0\n"
                                                   "1,ground,-1,0,0,0,.2,.2,.2,0,0,0\n"
                                                   "2,window,4,0,0,0,.1,.1,.1,10,20,30\n"
                                                   "3,wall,4,0,1,0,.5,.4,.3,0,0,0\n";
    const Result<ShapeTree> result = read(obj, csv);
    ASSERT_TRUE(result.ok()) << result.error().message;
    const ShapeTree& tree = *result;
    // Building, facade, floor, bay, wall; ground x 4, quad; window; floor, bay, wall.
    ASSERT_EQ(tree.shapes.size(), 14u);
    EXPECT_EQ(tree.buildingIds, std::vector<std::string>{"4"});
    std::string path;
    for (u32 s = 13; s != kNoIndex; s = tree.shapes[s].parent) path += tree.names[tree.shapes[s].name] + " ";
    EXPECT_EQ(path, "wall Bay Floor Facade Building ");
    std::vector<u32> faces;
    for (const Shape& shape : tree.shapes) {
        if (shape.polygonCount == 0) continue;
        faces.push_back(shape.sourceFace);
        EXPECT_EQ(shape.building, shape.sourceFace == 1 ? kNoIndex : 0u);
        EXPECT_EQ(tree.surfaces[shape.surface].name, tree.names[shape.name]);
    }
    EXPECT_EQ(faces, (std::vector<u32>{0, 1, 2, 3}));
    EXPECT_EQ(tree.shapes[5].op, ShapeOp::Root);
    EXPECT_EQ(tree.names[tree.shapes[5].name], "Ground");
    EXPECT_EQ(tree.surfaces.size(), 3u);
    const Surface& window = tree.surfaces[2];
    EXPECT_DOUBLE_EQ(window.emission.a, 0.2126 * 10 + 0.7152 * 20 + 0.0722 * 30);
    EXPECT_EQ(area(tree.polygons[0]), 4.0);
    EXPECT_EQ(area(tree.polygons[1]), 2.0);
    EXPECT_EQ(area(tree.polygons[3]), 6.0); // shoelace of (0,0) (4,0) (4,4) (2,1): (16 - 4) / 2
    EXPECT_EQ(tree.polygons[0].outer[2], glm::dvec3(2, 2, 0));
}

TEST_F(Surfaces, ReadColumnsByNameAndTheSolarChannel)
{
    const Result<ShapeTree> tree =
        read(std::string(kSquare) + "f 1 2 3 4\n",
             "emit_solar,bay,floor,facade,building,kind,rho_solar,rho_b,rho_g,rho_r,emit_b,emit_g,emit_r\r\n"
             "9,0,0,0,0,\"wall\",0.6,0.3,0.2,0.1,3,2,1\r\n");
    ASSERT_TRUE(tree.ok()) << tree.error().message;
    EXPECT_EQ(tree->surfaces[0], (Surface{"wall", {0.1, 0.2, 0.3, 0.6}, {1, 2, 3, 9}}));
}

TEST_F(Surfaces, NameFileAndLineOfABadFace)
{
    const std::string row = std::string(kHeader) + "0,wall,0,0,0,0,.5,.4,.3,0,0,0\n";
    const std::string square = kSquare;
    EXPECT_TRUE(errorOf("v 0 0 x\n", row).starts_with("obj:1: coordinate \"x\""));
    EXPECT_TRUE(errorOf("v 0 0\n", row).starts_with("obj:1: coordinate \"\""));
    EXPECT_TRUE(errorOf("v 0 0 nan\n", row).starts_with("obj:1:"));
    EXPECT_TRUE(errorOf(square + "f 1 2 5\n", row).starts_with("obj:5: vertex 5 does not exist"));
    EXPECT_TRUE(errorOf(square + "f 0 1 2\n", row).starts_with("obj:5: vertex 0"));
    EXPECT_TRUE(errorOf(square + "f -5 1 2\n", row).starts_with("obj:5: vertex -5"));
    EXPECT_TRUE(errorOf(square + "f 1 a 2\n", row).starts_with("obj:5: corner \"a\""));
    EXPECT_TRUE(errorOf(square + "f 1 2\n", row).starts_with("obj:5: face with 2 corners"));
    EXPECT_TRUE(errorOf(square + "f 1 2 1\n", row).starts_with("obj:5: face without area"));
    EXPECT_TRUE(errorOf(square + "v 0 2 0.1\nf 1 2 3 5\n", row).starts_with("obj:6: face is not planar"));
    EXPECT_TRUE(errorOf("# nothing\n", kHeader).starts_with("obj: no face"));
    // 1 mm on 2.8 m is within a thousandth of the size.
    EXPECT_TRUE(read(square + "v 0 2 0.001\nf 1 2 3 5\n", row).ok());
}

TEST_F(Surfaces, NameFileAndLineOfABadRow)
{
    const std::string obj = std::string(kSquare) + "f 1 2 3 4\n";
    const std::string header = kHeader;
    EXPECT_TRUE(errorOf(obj, "kind,building\n").starts_with("csv:1: no column \"facade\""));
    EXPECT_TRUE(errorOf(obj, "").starts_with("csv:1: no column"));
    EXPECT_TRUE(errorOf(obj, header).starts_with("csv: 0 rows for the 1 faces"));
    EXPECT_TRUE(
        errorOf(obj, header + "0,w,0,0,0,0,.5,.4,.3,0,0,0\n1,w,0,0,0,0,.5,.4,.3,0,0,0\n").starts_with("csv: 2 rows"));
    EXPECT_TRUE(
        errorOf(obj, header + "0,w,0,0,0,0,1.01,.4,.3,0,0,0\n").starts_with("csv:2: rho_r \"1.01\" is outside"));
    EXPECT_TRUE(errorOf(obj, header + "0,w,0,0,0,0,.5,-.1,.3,0,0,0\n").starts_with("csv:2: rho_g"));
    EXPECT_TRUE(errorOf(obj, header + "0,w,0,0,0,0,.5,.4,.3,0,-1,0\n").starts_with("csv:2: emit_g \"-1\" is negative"));
    EXPECT_TRUE(errorOf(obj, header + "0,w,0,0,0,0,.5,.4,red,0,0,0\n").starts_with("csv:2: rho_b \"red\""));
    EXPECT_TRUE(errorOf(obj, header + "0,w,0,0,1.5,0,.5,.4,.3,0,0,0\n").starts_with("csv:2: floor \"1.5\""));
    EXPECT_TRUE(errorOf(obj, header + "0,w,-2,0,0,0,.5,.4,.3,0,0,0\n").starts_with("csv:2: building \"-2\""));
    EXPECT_TRUE(errorOf(obj, header + "0,w,0,0\n").starts_with("csv:2: only 4 fields"));
}

TEST_F(Surfaces, NameAMissingFile)
{
    const auto tree = readSurfaces("/nowhere/scene.obj", "/nowhere/scene.csv");
    ASSERT_FALSE(tree.ok());
    EXPECT_TRUE(tree.error().message.starts_with("/nowhere/scene.obj: "));
}

} // namespace
