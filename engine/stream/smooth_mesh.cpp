// SPDX-License-Identifier: Apache-2.0
#include "engine/stream/smooth_mesh.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/geometric.hpp>
#include <glm/vec3.hpp>
#include <iterator>
#include <numeric>
#include <utility>

#include "city/base/check.h"
#include "engine/stream/corners.h"

namespace helio {

namespace {

constexpr double kSameNormal = 0.9999; // cosine: packed normals are true to a tenth of a degree
constexpr double kOffPlane = 0.02; // m: patches may be bent by a centimetre; reveals and parts of assets are further

struct Triangle
{
    u32 patch;
    u32 albedo;                 // packed
    u32 firstIndex;             // of the three in the static mesh
    bool hasCorners;            // in the plane of its patch, which is not dark
    std::array<u32, 3> corners; // counter-clockwise, if it has any
};

struct Edge
{
    u32 from, to; // corners
    Edge reversed() const { return {to, from}; }
    auto operator<=>(const Edge&) const = default;
};

std::array<Edge, 3> edgesOf(const Triangle& t)
{
    const auto [a, b, c] = t.corners;
    return {{{a, b}, {b, c}, {c, a}}};
}

std::vector<Edge> sortedEdges(std::span<const Triangle> triangles)
{
    std::vector<Edge> edges;
    for (const Triangle& t : triangles)
        for (const Edge& edge : edgesOf(t)) edges.push_back(edge);
    std::sort(edges.begin(), edges.end());
    return edges;
}

bool contains(const std::vector<Edge>& sorted, const Edge& edge)
{
    return std::binary_search(sorted.begin(), sorted.end(), edge);
}

glm::dvec3 positionOf(const Corners& corners, u32 corner)
{
    return corners.all()[corner].position;
}

glm::dvec3 areaVector(const glm::dvec3& a, const glm::dvec3& b, const glm::dvec3& c)
{
    return 0.5 * glm::cross(b - a, c - a);
}

glm::dvec3 areaVector(const Corners& corners, const Triangle& t)
{
    return areaVector(positionOf(corners, t.corners[0]), positionOf(corners, t.corners[1]),
                      positionOf(corners, t.corners[2]));
}

bool isThin(const Corners& corners, const Triangle& t)
{
    double longest = 0.0;
    for (const auto& [from, to] : edgesOf(t))
        longest = std::max(longest, glm::distance(positionOf(corners, from), positionOf(corners, to)));
    return 2.0 * glm::length(areaVector(corners, t)) <= double(kCornerJoin) * longest;
}

/// Writes the triangles of one patch after the other.
class PatchWriter
{
public:
    PatchWriter(SmoothMesh& mesh, const Corners& corners)
        : mesh_(mesh), corners_(corners), vertexAt_(corners.all().size(), gpu::kNone)
    {
    }

    /// Is all of the border seen from here, from its inner side? Only then does a fan cover what it encloses, once.
    bool sees(const glm::dvec3& middle, const glm::dvec3& up, std::span<const Edge> border) const
    {
        return !border.empty() && std::all_of(border.begin(), border.end(), [&](const Edge& edge) {
            const double length = glm::distance(positionOf(corners_, edge.from), positionOf(corners_, edge.to));
            return 2.0 * area(middle, up, edge) > double(kCornerJoin) * length;
        });
    }
    /// like: a vertex of the patch; up: the unit normal. alone: the fan's middle takes the value of the patch.
    void fan(const gpu::VertexRecord& like, const glm::dvec3& middle, const glm::dvec3& up,
             std::span<const Edge> border, bool alone)
    {
        gpu::VertexRecord centre = like;
        centre.position = middle;
        const u32 centreVertex = vertex(centre, alone ? mesh_.cornerCount + like.patchId : nextFan());
        double whole = 0.0;
        fan_.clear();
        for (const Edge& edge : border) {
            const double part = area(centre.position, up, edge);
            if (part <= 0.0) continue; // by a border that is moved by less than kCornerJoin
            mesh_.indices.insert(mesh_.indices.end(), {centreVertex, at(edge.from, like), at(edge.to, like)});
            for (const u32 corner : {edge.from, edge.to}) {
                seen_.push_back({corner, part});
                fan_.push_back({corner, part});
            }
            whole += part;
        }
        area_ += whole;
        if (alone) return;
        addWeights(fan_, 2.0 * whole, mesh_.fanWeights);
        endFan();
    }
    /// Triangles that stay as they are, with one value.
    void flat(std::span<const gpu::VertexRecord> corners)
    {
        const u32 fan = nextFan();
        for (const gpu::VertexRecord& v : corners) mesh_.indices.push_back(vertex(v, fan));
        endFan();
    }
    /// Ends what shares vertices: the patch's triangles of one colour.
    void endColour()
    {
        for (const u32 corner : drawn_) vertexAt_[corner] = gpu::kNone;
        drawn_.clear();
    }
    void endPatch(u32 patch)
    {
        mesh_.patchRows[patch + 1] = addWeights(seen_, area_, mesh_.patchWeights);
        mesh_.fanRows[patch + 1] = std::exchange(fans_, 0);
        seen_.clear();
        area_ = 0.0;
    }

private:
    struct Part
    {
        u32 corner;
        double area; // m2, of a triangle there
    };
    /// The sums of the parts of each corner over `area`; returns their number.
    static u32 addWeights(std::vector<Part>& parts, double area, std::vector<gpu::CornerWeightRecord>& weights)
    {
        std::stable_sort(parts.begin(), parts.end(), [](const Part& a, const Part& b) { return a.corner < b.corner; });
        const size_t before = weights.size();
        for (auto first = parts.begin(); first != parts.end();) {
            double sum = 0.0;
            const u32 corner = first->corner;
            for (; first != parts.end() && first->corner == corner; ++first) sum += first->area;
            weights.push_back({corner, float(sum / area)});
        }
        return u32(weights.size() - before);
    }
    double area(const glm::dvec3& middle, const glm::dvec3& up, const Edge& edge) const
    {
        return glm::dot(areaVector(middle, positionOf(corners_, edge.from), positionOf(corners_, edge.to)), up);
    }
    u32 nextFan() const { return u32(mesh_.cornerCount + mesh_.patchRows.size() - 1 + mesh_.fanWeightRows.size() - 1); }
    void endFan()
    {
        mesh_.fanWeightRows.push_back(u32(mesh_.fanWeights.size()));
        ++fans_;
    }
    u32 vertex(const gpu::VertexRecord& v, u32 value)
    {
        mesh_.vertices.push_back(v);
        mesh_.valueOfVertex.push_back(value);
        return u32(mesh_.vertices.size() - 1);
    }
    u32 at(u32 corner, gpu::VertexRecord like)
    {
        if (vertexAt_[corner] == gpu::kNone) {
            like.position = corners_.all()[corner].position;
            vertexAt_[corner] = vertex(like, corner);
            drawn_.push_back(corner);
        }
        return vertexAt_[corner];
    }

    SmoothMesh& mesh_;
    const Corners& corners_;
    std::vector<u32> vertexAt_; // a corner, of the colour in hand
    std::vector<u32> drawn_;    // corners that have one
    std::vector<Part> seen_;    // of the patch in hand
    double area_ = 0.0;         // m2, likewise
    u32 fans_ = 0;              // with a value of their own, likewise
    std::vector<Part> fan_;     // of the fan in hand
};

/// Edges of triangles, with the corners inside them.
class Border
{
public:
    Border(const Corners& corners, const std::vector<Edge>& allEdges, std::span<const Triangle> patch)
        : corners_(corners), allEdges_(allEdges), own_(sortedEdges(patch))
    {
    }
    /// Of all triangles: edges that no other of them has from the other side.
    std::vector<Edge> whole() const
    {
        std::vector<Edge> out;
        for (const Edge& edge : own_)
            if (!contains(own_, edge.reversed())) split(edge, out);
        return out;
    }
    std::vector<Edge> around(const Triangle& t) const
    {
        std::vector<Edge> out;
        for (const Edge& edge : edgesOf(t)) split(edge, out);
        return out;
    }

private:
    void split(const Edge& edge, std::vector<Edge>& out) const
    {
        u32 from = edge.from;
        // Where a triangle lies on the other side of the whole edge there is nothing to look for.
        if (!contains(allEdges_, edge.reversed()))
            for (const u32 corner : corners_.inside(edge.from, edge.to)) {
                out.push_back({from, corner});
                from = corner;
            }
        out.push_back({from, edge.to});
    }

    const Corners& corners_;
    const std::vector<Edge>& allEdges_; // sorted
    std::vector<Edge> own_;             // sorted
};

/// Fans for triangles of a patch, all of one colour and none of them thin. like: a vertex.
/// alone: the patch has no others.
void addFans(PatchWriter& writer, const gpu::VertexRecord& like, const Corners& corners,
             const std::vector<Edge>& allEdges, std::span<const Triangle> triangles, bool alone)
{
    const auto middleOf = [&](const Triangle& t) {
        const auto [a, b, c] = t.corners;
        return (positionOf(corners, a) + positionOf(corners, b) + positionOf(corners, c)) / 3.0;
    };
    glm::dvec3 moment(0.0), up(0.0);
    double area = 0.0;
    for (const Triangle& t : triangles) {
        const glm::dvec3 part = areaVector(corners, t);
        up += part;
        area += glm::length(part);
        moment += glm::length(part) * middleOf(t);
    }
    const Border border(corners, allEdges, triangles);
    const std::vector<Edge> whole = border.whole();
    if (writer.sees(moment / area, glm::normalize(up), whole)) {
        writer.fan(like, moment / area, glm::normalize(up), whole, alone);
        return;
    }
    for (const Triangle& t : triangles)
        writer.fan(like, middleOf(t), glm::normalize(areaVector(corners, t)), border.around(t), false);
}

glm::vec3 unpackNormal(u32 packed)
{
    const auto part = [&](u32 shift) { return float(i32(packed << (22 - shift)) >> 22) / 511.0f; };
    return glm::normalize(glm::vec3(part(0), part(10), part(20)));
}

/// Triangles of the static mesh by patch and colour, without their corners. The plane of a patch goes through its first
/// vertex that has its normal.
std::vector<Triangle> sortedTriangles(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices,
                                      std::span<const gpu::PatchRecord> patches, const std::vector<bool>& dark)
{
    std::vector<const gpu::VertexRecord*> onPlane(patches.size(), nullptr);
    const auto inPlane = [&](u32 index) {
        const gpu::VertexRecord& v = vertices[index];
        const glm::vec3 normal = patches[v.patchId].normal;
        if (double(glm::dot(normal, unpackNormal(v.normal))) < kSameNormal) return false;
        const gpu::VertexRecord*& first = onPlane[v.patchId];
        if (first == nullptr) first = &v;
        return std::abs(double(glm::dot(normal, v.position - first->position))) <= kOffPlane;
    };
    std::vector<Triangle> triangles;
    triangles.reserve(indices.size() / 3);
    for (u32 k = 0; k + 2 < indices.size(); k += 3) {
        const gpu::VertexRecord& v = vertices[indices[k]];
        HELIO_CHECK(v.patchId < patches.size(), "patch ", v.patchId, " of ", patches.size());
        const bool lit = dark.empty() || !dark[v.patchId];
        const bool plane = inPlane(indices[k]) && inPlane(indices[k + 1]) && inPlane(indices[k + 2]);
        triangles.push_back({v.patchId, v.albedo, k, lit && plane, {}});
    }
    std::stable_sort(triangles.begin(), triangles.end(), [](const Triangle& a, const Triangle& b) {
        return a.patch != b.patch ? a.patch < b.patch : a.albedo < b.albedo;
    });
    return triangles;
}

/// The patches of each corner: the weights the other way round.
void turnRows(SmoothMesh& mesh)
{
    mesh.cornerRows.assign(mesh.cornerCount + 1, 0);
    for (const gpu::CornerWeightRecord& w : mesh.patchWeights) ++mesh.cornerRows[w.corner + 1];
    std::partial_sum(mesh.cornerRows.begin(), mesh.cornerRows.end(), mesh.cornerRows.begin());
    mesh.cornerPatches.resize(mesh.patchWeights.size());
    std::vector<u32> next = mesh.cornerRows;
    for (u32 patch = 0; patch + 1 < mesh.patchRows.size(); ++patch)
        for (u32 k = mesh.patchRows[patch]; k < mesh.patchRows[patch + 1]; ++k)
            mesh.cornerPatches[next[mesh.patchWeights[k].corner]++] = patch;
}

} // namespace

std::vector<bool> darkPatches(const TileView& tile)
{
    if (tile.linkRows.empty()) return {};
    const auto hasLinks = [](std::span<const u32> rows, u32 row) { return rows[row] < rows[row + 1]; };
    std::vector<bool> dark(tile.patches.size(), false);
    for (u32 i = 0; i < tile.patches.size(); ++i) {
        bool lit = hasLinks(tile.skyRows, i);
        for (u32 node = i; !lit && node != gpu::kNone; node = tile.nodes[node].parent)
            lit = hasLinks(tile.linkRows, node);
        dark[i] = !lit;
    }
    return dark;
}

SmoothMesh buildSmoothMesh(std::span<const gpu::VertexRecord> vertices, std::span<const u32> indices,
                           std::span<const gpu::PatchRecord> patches, const std::vector<bool>& dark)
{
    HELIO_CHECK(dark.empty() || dark.size() == patches.size(), dark.size(), " of ", patches.size(), " patches");
    std::vector<Triangle> triangles = sortedTriangles(vertices, indices, patches, dark);
    std::vector<u32> joined;
    for (const Triangle& t : triangles)
        if (t.hasCorners)
            for (u32 k = 0; k < 3; ++k) joined.push_back(indices[t.firstIndex + k]);
    const Corners corners(vertices, joined, patches);
    std::vector<Triangle> fanned;
    for (Triangle& t : triangles) {
        if (!t.hasCorners) continue;
        for (u32 k = 0; k < 3; ++k) t.corners[k] = corners.ofVertex(indices[t.firstIndex + k]);
        if (!isThin(corners, t)) fanned.push_back(t);
    }
    const std::vector<Edge> edges = sortedEdges(fanned);

    SmoothMesh mesh;
    mesh.cornerCount = u32(corners.all().size());
    mesh.patchRows.resize(patches.size() + 1);
    mesh.fanRows.resize(patches.size() + 1);
    mesh.fanWeightRows = {0};
    PatchWriter writer(mesh, corners);
    auto fannedFirst = fanned.begin();
    std::vector<gpu::VertexRecord> flat;
    for (auto first = triangles.begin(), end = first; first != triangles.end(); first = end) {
        const auto isOther = [&](const Triangle& t) { return t.patch != first->patch || t.albedo != first->albedo; };
        end = std::find_if(first, triangles.end(), isOther);
        const auto fannedEnd = std::find_if(fannedFirst, fanned.end(), isOther);
        const std::span<const Triangle> fans(fannedFirst, fannedEnd);
        const bool alone = (fannedFirst == fanned.begin() || std::prev(fannedFirst)->patch != first->patch) &&
                           (fannedEnd == fanned.end() || fannedEnd->patch != first->patch);
        if (!fans.empty()) addFans(writer, vertices[indices[fans.front().firstIndex]], corners, edges, fans, alone);
        for (const Triangle& t : std::span<const Triangle>(first, end))
            for (u32 k = 0; k < 3 && (!t.hasCorners || fans.empty()); ++k)
                flat.push_back(vertices[indices[t.firstIndex + k]]);
        writer.endColour();
        if (end == triangles.end() || end->patch != first->patch) {
            if (!flat.empty()) writer.flat(flat);
            flat.clear();
            writer.endPatch(first->patch);
        }
        fannedFirst = fannedEnd;
    }
    for (std::vector<u32>* rows : {&mesh.patchRows, &mesh.fanRows})
        std::partial_sum(rows->begin(), rows->end(), rows->begin());
    turnRows(mesh);
    return mesh;
}

} // namespace helio
