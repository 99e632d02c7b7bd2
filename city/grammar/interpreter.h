// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <tuple>

#include "city/grammar/component.h"
#include "city/grammar/evaluator.h"
#include "city/grammar/occlusion.h"

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
    std::vector<Shape> shapes;          ///< name: into Program::names, or past its end for kOperationNames
    std::vector<Polygon3> polygons;     ///< m, z up
    std::vector<glm::dvec4> trimPlanes; ///< as ShapeTree::trimPlanes
    std::vector<Surface> surfaces;
    std::vector<std::string> assets;
    std::map<std::string, double> reports;
    RoofCounts roofs;               ///< of roofHip, roofGable, roofShed and roofPyramid
    std::vector<std::string> notes; ///< one line each, naming the building: why a roof became simpler; the first few
    u32 droppedOpenings = 0;        ///< assets on covered parts of walls
};

/// Names of nodes that no rule names, numbered after Program::names.
inline constexpr std::string_view kOperationNames[] = {"split",   "comp",        "push",       "setback",
                                                       "scatter", "WallSurface", "RoofSurface"};
enum class OperationName : u32
{
    Split,
    Component,
    Push,
    Setback, ///< setback, shapeL, innerRectangle, ..
    Scatter,
    WallSurface, ///< a given surface for which there is no rule
    RoofSurface
};

/// Area that a subtree put into the plane of the face it stands on, m2.
struct Covered
{
    double planar = 0.0; ///< of patches
    double overlay =
        0.0;     ///< of tiles whose only content is an asset in front of them: a hole unless something else fills it
    Place place; ///< of such a tile
};

/// Derives one building. operations.cpp says which file carries out which operation; leaves are in leaf.cpp, given
/// surfaces in given_faces.cpp.
class Interpreter
{
public:
    Interpreter(const Program& program, const Footprint& footprint, const DeriveOptions& options, AssetBoxes& boxes,
                u64 seed, Trouble& trouble);

    /// Runs the start rule on the footprint; on a footprint with given faces, the rules of their kinds on them.
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
    std::vector<Value> entryValues(const Rule& rule, std::span<const Value> arguments, const ShapeState& state,
                                   Frame& frame);
    void spawnRule(const Statement& call, const ShapeState& state, Frame& parent, ShapeOp op,
                   std::span<const Value> arguments);
    void spawnPart(const Body& body, ShapeState state, Frame& parent, ShapeOp op, OperationName name);
    void runPush(const Statement& statement, const ShapeState& state, Frame& frame);
    void finish(Frame& frame, Frame& parent, const ShapeState& start, const ShapeState& end, Place place);

    // given_faces.cpp
    void runGivenFaces(const Rule& start, Frame& root, const ShapeState& lot);
    u32 edgeUnder(const glm::dvec3& a, const glm::dvec3& b) const;

    // operations.cpp
    void runOperation(const Statement& statement, ShapeState& state, Frame& frame);
    void report(const Statement& statement, const ShapeState& state, Frame& frame);
    void print(const Statement& statement, const ShapeState& state, Frame& frame);
    glm::dvec3 vectorArgs(const Statement& statement, const ShapeState& state, Frame& frame);
    glm::bvec3 axisArgs(const Statement& statement, const ShapeState& state, Frame& frame);
    bool checkSize(const ShapeState& state, Place place);
    bool refuseAfterInsert(const Statement& statement, const ShapeState& state);
    static void replaceShape(ShapeState& state, Geometry geometry);

    // placement.cpp
    std::pair<glm::dvec3, glm::dmat3> systemOf(CoordinateSystem system, const ShapeState& state) const;
    void translate(const Statement& statement, ShapeState& state, Frame& frame);
    void resize(const Statement& statement, ShapeState& state, Frame& frame);
    void rotate(const Statement& statement, ShapeState& state, Frame& frame);
    void rotateScope(const Statement& statement, ShapeState& state, Frame& frame);
    void turnAround(const Statement& statement, ShapeState& state, const glm::dmat3& axes, bool pivot);
    void center(const Statement& statement, ShapeState& state, Frame& frame);
    void mirrorScope(const Statement& statement, ShapeState& state, Frame& frame);
    void setPivot(const Statement& statement, ShapeState& state, Frame& frame);

    // align.cpp
    void alignToAxes(const Statement& statement, ShapeState& state);
    void alignToGeometry(const Statement& statement, ShapeState& state, Frame& frame);
    void alignToBounds(const Statement& statement, ShapeState& state);

    // shaping.cpp
    void extrudeShape(const Statement& statement, ShapeState& state, Frame& frame);
    void mirror(const Statement& statement, ShapeState& state, Frame& frame);
    void reverseNormals(const Statement& statement, ShapeState& state);
    void cleanup(const Statement& statement, ShapeState& state, Frame& frame);
    void deleteHoles(const Statement& statement, ShapeState& state);

    // insert.cpp
    void primitive(const Statement& statement, ShapeState& state, Frame& frame);
    void insertPrimitive(Operation op, std::span<const double> numbers, Place place, ShapeState& state);
    void insertAsset(const Statement& statement, ShapeState& state, Frame& frame);

    // surface.cpp
    void setColor(const Statement& statement, ShapeState& state, Frame& frame);
    void set(const Statement& statement, ShapeState& state, Frame& frame);

    // subdivide.cpp
    void split(const Statement& statement, const ShapeState& state, Frame& frame);
    void components(const Statement& statement, const ShapeState& state, Frame& frame);
    void spawnComponents(const BlockElement& element, ComponentKind kind,
                         const std::vector<const Component*>& components, const std::vector<MeshEdge>& edges,
                         const ShapeState& state, Frame& frame);
    /// Makes shapes of faces in the coordinates of the state's scope, which keep its axes.
    void spawnPieces(const BlockElement& element, std::vector<Face> faces, const ShapeState& state, Frame& frame,
                     ShapeOp op, OperationName name);
    SelectorContext selectorContext(const ShapeState& state, const std::optional<StreetSides>& streets) const;
    bool refuseAsset(const Statement& statement, const ShapeState& state);

    // scatter_operation.cpp
    void scatter(const Statement& statement, const ShapeState& state, Frame& frame);

    // roof_operations.cpp
    void roof(const Statement& statement, ShapeState& state, Frame& frame);

    // setback_operations.cpp
    void setback(const Statement& statement, const ShapeState& state, Frame& frame);
    void wings(const Statement& statement, const ShapeState& state, Frame& frame);
    void spawnShapeAndRest(const Statement& statement, const ShapeState& state, Frame& frame, std::vector<Face> shapes,
                           std::vector<Face> rest);
    void innerRectangle(const Statement& statement, const ShapeState& state, Frame& frame);
    void innerRect(const Statement& statement, ShapeState& state);
    void offsetFaces(const Statement& statement, ShapeState& state, Frame& frame);
    bool needsFaces(const Statement& statement, const ShapeState& state);

    // trim.cpp
    void trim(const Statement& statement, ShapeState& state);
    void addTrim(const ShapeState& state, Shape& shape);

    // leaf.cpp
    bool emitLeaf(const ShapeState& state, Frame& frame, Place place);
    bool addSurfaces(const ShapeState& state, const Scope& scope, const Geometry& geometry, const Frame& frame,
                     Place place);
    bool fillsTile(const ShapeState& state) const;
    bool onCoveredPart(const ShapeState& state) const;
    u32 surfaceOf(const Look& look);
    void addPolygons(const Scope& scope, const Geometry& geometry, Shape& shape);

    const Program& program_;
    const Footprint& footprint_;
    AssetBoxes& boxes_;
    u64 seed_;
    Trouble& trouble_;
    Occlusion occlusion_; ///< before evaluator_, which asks it
    Evaluator evaluator_;
    BuildingShapes result_;
    glm::dvec3 objectOrigin_{0.0};
    glm::dmat3 objectAxes_{1.0};
    u32 printCount_ = 0;
    std::map<std::tuple<std::string, std::array<double, 8>>, u32> surfaceIndex_;
    std::map<std::string, u32> assetIndex_;
};

} // namespace helio::cga
