// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <tuple>

#include "city/grammar/evaluator.h"

namespace helio::cga {

/// Boxes of assets by name, shared by all threads of a derivation.
class AssetBoxes
{
public:
    virtual ~AssetBoxes() = default;
    virtual Result<AssetBox> find(const std::string& name) = 0;
};

/// One building's part of the shape tree, with indices of its own.
struct BuildingShapes
{
    std::vector<Shape> shapes;      ///< name: into Program::names, or past its end for kOperationNames
    std::vector<Polygon3> polygons; ///< m, z up
    std::vector<Surface> surfaces;
    std::vector<std::string> assets;
    std::map<std::string, double> reports;
};

/// Names of nodes that no rule names, numbered after Program::names.
inline constexpr std::string_view kOperationNames[] = {"split", "comp", "push"};
enum class OperationName : u32
{
    Split,
    Component,
    Push
};

/// Area that a subtree put into the plane of the face it stands on, m2.
struct Covered
{
    double planar = 0.0; ///< of patches
    double overlay =
        0.0;     ///< of tiles whose only content is an asset in front of them: a hole unless something else fills it
    Place place; ///< of such a tile
};

/// Derives one building. Operations are in operations.cpp, subdivisions in subdivide.cpp, leaves in leaf.cpp.
class Interpreter
{
public:
    Interpreter(const Program& program, const Footprint& footprint, const DeriveOptions& options, AssetBoxes& boxes,
                u64 seed, Trouble& trouble);

    /// Runs the start rule on the footprint.
    BuildingShapes run(u32 startRule);

private:
    /// A node of the tree while its body runs.
    struct Frame
    {
        u32 node = 0;
        u32 rule = 0; ///< name, for messages
        u64 seed = 0;
        Random random{0};
        std::span<const Value> parameters;
        u32 depth = 0;
        u32 childCount = 0;
        bool spawned = false; ///< a successor was met: the shape itself is no leaf
        bool deleted = false; ///< NIL
        Scope outer;          ///< what center() refers to
        Covered covered;
    };

    Env env(const ShapeState& state, Frame& frame) const { return {&state, frame.parameters, &frame.random}; }

    // Bodies
    const Body* choose(const Body& body, const ShapeState& state, Frame& frame);
    void runBody(const Body& body, ShapeState& state, Frame& frame);
    void runStatement(const Statement& statement, ShapeState& state, Frame& frame);
    Frame childFrame(Frame& parent, u32 name, ShapeOp op, Place place);
    void spawnRule(const Statement& call, const ShapeState& state, Frame& parent, ShapeOp op,
                   std::span<const Value> arguments);
    void spawnPart(const Body& body, ShapeState state, Frame& parent, ShapeOp op, OperationName name);
    void runPush(const Statement& statement, const ShapeState& state, Frame& frame);
    void finish(Frame& frame, Frame& parent, const ShapeState& start, const ShapeState& end, Place place);

    // operations.cpp
    void runOperation(const Statement& statement, ShapeState& state, Frame& frame);
    glm::dvec3 vectorArgs(const Statement& statement, const ShapeState& state, Frame& frame);
    void resize(const Statement& statement, ShapeState& state, Frame& frame);
    void rotate(const Statement& statement, ShapeState& state, Frame& frame);
    void center(const Statement& statement, ShapeState& state, Frame& frame);
    void extrudeShape(const Statement& statement, ShapeState& state, Frame& frame);
    void primitive(const Statement& statement, ShapeState& state, Frame& frame);
    void setColor(const Statement& statement, ShapeState& state, Frame& frame);
    void set(const Statement& statement, ShapeState& state, Frame& frame);
    void insertAsset(const Statement& statement, ShapeState& state, Frame& frame);
    void alignToAxes(const Statement& statement, ShapeState& state);
    bool checkSize(const ShapeState& state, Place place);

    // subdivide.cpp
    void split(const Statement& statement, const ShapeState& state, Frame& frame);
    void components(const Statement& statement, const ShapeState& state, Frame& frame);
    void spawnFaces(const BlockElement& element, const std::vector<const Face*>& faces, const ShapeState& state,
                    Frame& frame);
    bool refuseAsset(const Statement& statement, const ShapeState& state);

    // leaf.cpp
    bool emitLeaf(const ShapeState& state, Frame& frame, Place place);
    bool fillsTile(const ShapeState& state) const;
    u32 surfaceOf(const Look& look);
    void addPolygons(const Scope& scope, const Geometry& geometry, Shape& shape);

    const Program& program_;
    const Footprint& footprint_;
    AssetBoxes& boxes_;
    u64 seed_;
    Trouble& trouble_;
    Evaluator evaluator_;
    BuildingShapes result_;
    glm::dmat3 objectAxes_{1.0};
    std::map<std::tuple<std::string, std::array<double, 8>>, u32> surfaceIndex_;
    std::map<std::string, u32> assetIndex_;
};

} // namespace helio::cga
