// SPDX-License-Identifier: Apache-2.0
#include "city/assets/asset.h"

#include <cmath>
#include <cstring>
#include <exception>
#include <glm/geometric.hpp>
#include <glm/mat4x4.hpp>
#include <glm/matrix.hpp>
#include <span>
#include <tiny_gltf.h>

#include "city/assets/front_view.h"
#include "city/base/file.h"
#include "city/model/materials.h"
#include "city/model/shape_tree.h"

namespace helio {

namespace {

constexpr size_t kMaxVertices = 4'000'000, kMaxIndices = 12'000'000; ///< of one asset
constexpr int kMaxNodeDepth = 32;
constexpr u32 kMaxNodeVisits = 100'000; ///< nodes that share children make exponentially many of them
constexpr float kMaxCoordinate = 1e6f;

/// Elements of an accessor, checked against buffer view and buffer.
struct Elements
{
    const unsigned char* data = nullptr;
    size_t count = 0, stride = 0;
};

/// Reads the meshes of a parsed file; the first fault sticks.
class Reader
{
public:
    Reader(const tinygltf::Model& model, AssetMesh& mesh) : model_(model), mesh_(mesh) {}

    bool run()
    {
        for (const std::string& name : model_.extensionsRequired)
            if (name != "KHR_materials_unlit")
                return fail(concat("it requires the extension ", name, ", which is not read: export it without"));
        if (model_.scenes.empty()) {
            for (size_t k = 0; k < model_.meshes.size(); ++k)
                if (!addMesh(int(k), glm::dmat4(1.0))) return false;
        } else {
            const size_t scene = model_.defaultScene >= 0 ? size_t(model_.defaultScene) : 0;
            if (scene >= model_.scenes.size()) return fail(concat("scene ", scene, " does not exist"));
            for (const int node : model_.scenes[scene].nodes)
                if (!addNode(node, glm::dmat4(1.0), 0)) return false;
        }
        if (mesh_.indices.empty()) return fail("it has no triangle mesh");
        return true;
    }

    const std::string& message() const { return message_; }
    const std::vector<glm::dvec4>& triangleRho() const { return triangleRho_; }

private:
    bool fail(std::string message)
    {
        if (message_.empty()) message_ = std::move(message);
        return false;
    }

    static glm::dmat4 transformOf(const tinygltf::Node& node)
    {
        glm::dmat4 m(1.0);
        if (node.matrix.size() == 16) {
            for (int k = 0; k < 16; ++k) m[k / 4][k % 4] = node.matrix[size_t(k)];
            return m;
        }
        if (node.rotation.size() == 4) { // unit quaternion x, y, z, w
            const double x = node.rotation[0], y = node.rotation[1], z = node.rotation[2], w = node.rotation[3];
            m[0] = {1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w), 0};
            m[1] = {2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w), 0};
            m[2] = {2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y), 0};
        }
        for (int k = 0; k < 3; ++k) {
            if (node.scale.size() == 3) m[k] *= node.scale[size_t(k)];
            if (node.translation.size() == 3) m[3][k] = node.translation[size_t(k)];
        }
        return m;
    }

    bool addNode(int index, const glm::dmat4& parent, int depth)
    {
        if (index < 0 || size_t(index) >= model_.nodes.size()) return fail(concat("node ", index, " does not exist"));
        if (depth > kMaxNodeDepth)
            return fail(concat("its nodes nest deeper than ", kMaxNodeDepth, " levels, or in a circle"));
        if (++nodeVisits_ > kMaxNodeVisits)
            return fail(concat("its scene has more than ", kMaxNodeVisits, " nodes, shared ones counted each time"));
        const tinygltf::Node& node = model_.nodes[size_t(index)];
        const glm::dmat4 transform = parent * transformOf(node);
        if (node.mesh >= 0 && !addMesh(node.mesh, transform)) return false;
        for (const int child : node.children)
            if (!addNode(child, transform, depth + 1)) return false;
        return true;
    }

    bool addMesh(int index, const glm::dmat4& transform)
    {
        if (index < 0 || size_t(index) >= model_.meshes.size()) return fail(concat("mesh ", index, " does not exist"));
        for (const tinygltf::Primitive& primitive : model_.meshes[size_t(index)].primitives)
            if (!addPrimitive(primitive, transform)) return false;
        return true;
    }

    bool addPrimitive(const tinygltf::Primitive& primitive, const glm::dmat4& transform)
    {
        if (primitive.mode != TINYGLTF_MODE_TRIANGLES && primitive.mode != -1)
            return fail("it has points, lines or strips; only triangle lists are read");
        const auto position = primitive.attributes.find("POSITION");
        if (position == primitive.attributes.end()) return fail("a primitive has no POSITION");
        Elements positions, normals;
        if (!elements(position->second, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT, positions)) return false;
        const auto normal = primitive.attributes.find("NORMAL");
        const bool hasNormals = normal != primitive.attributes.end();
        if (hasNormals && !elements(normal->second, TINYGLTF_TYPE_VEC3, TINYGLTF_COMPONENT_TYPE_FLOAT, normals))
            return false;
        if (hasNormals && normals.count != positions.count)
            return fail("a primitive has another number of normals than of positions");
        if (mesh_.positions.size() + positions.count > kMaxVertices)
            return fail(concat("it has more than ", kMaxVertices, " vertices"));

        const size_t firstVertex = mesh_.positions.size(), firstIndex = mesh_.indices.size();
        const auto [albedo, rho, glass] = materialOf(primitive.material);
        const glm::dmat3 normalTurn = glm::transpose(glm::inverse(glm::dmat3(transform)));
        for (size_t k = 0; k < positions.count; ++k) {
            glm::vec3 p, n(0.0f);
            std::memcpy(&p, positions.data + k * positions.stride, sizeof p);
            if (hasNormals) std::memcpy(&n, normals.data + k * normals.stride, sizeof n);
            const glm::vec3 placed(transform * glm::dvec4(p, 1.0));
            for (int axis = 0; axis < 3; ++axis)
                if (!(std::abs(placed[axis]) < kMaxCoordinate))
                    return fail(concat("vertex ", k, " is not finite or larger than ", kMaxCoordinate));
            mesh_.positions.push_back(placed);
            mesh_.normals.push_back(glm::vec3(normalTurn * glm::dvec3(n)));
            mesh_.albedos.push_back(albedo);
            mesh_.isGlass.push_back(glass);
        }
        if (!addIndices(primitive.indices, positions.count, firstVertex)) return false;
        if (glm::determinant(glm::dmat3(transform)) < 0.0) // a mirrored node turns its triangles inside out
            for (size_t k = firstIndex; k + 2 < mesh_.indices.size(); k += 3)
                std::swap(mesh_.indices[k], mesh_.indices[k + 1]);
        triangleRho_.resize(mesh_.indices.size() / 3, rho);
        finishNormals(firstVertex, firstIndex);
        return true;
    }

    bool addIndices(int accessor, size_t vertexCount, size_t firstVertex)
    {
        Elements indices;
        int componentType = 0;
        if (accessor >= 0) {
            if (size_t(accessor) < model_.accessors.size())
                componentType = model_.accessors[size_t(accessor)].componentType;
            if (componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_BYTE &&
                componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_SHORT &&
                componentType != TINYGLTF_COMPONENT_TYPE_UNSIGNED_INT)
                return fail("its indices are no unsigned integers");
            if (!elements(accessor, TINYGLTF_TYPE_SCALAR, componentType, indices)) return false;
        } else {
            indices.count = vertexCount;
        }
        if (indices.count % 3 != 0)
            return fail(concat("it has ", indices.count, " indices, which is no whole number of triangles"));
        if (mesh_.indices.size() + indices.count > kMaxIndices)
            return fail(concat("it has more than ", kMaxIndices, " indices"));
        for (size_t k = 0; k < indices.count; ++k) {
            u32 index = u32(k);
            if (accessor >= 0) {
                index = 0;
                std::memcpy(
                    &index, indices.data + k * indices.stride,
                    size_t(tinygltf::GetComponentSizeInBytes(u32(componentType)))); // little endian, as the file
            }
            if (index >= vertexCount)
                return fail(concat("index ", k, " is ", index, ", but there are only ", vertexCount, " vertices"));
            mesh_.indices.push_back(u32(firstVertex) + index);
        }
        return true;
    }

    /// Makes normals unit; missing or zero ones become the mean of the triangles around them.
    void finishNormals(size_t firstVertex, size_t firstIndex)
    {
        std::vector<glm::vec3> means(mesh_.positions.size() - firstVertex, glm::vec3(0.0f));
        for (size_t k = firstIndex; k < mesh_.indices.size(); k += 3) {
            const u32* v = &mesh_.indices[k];
            const glm::vec3 n = glm::cross(mesh_.positions[v[1]] - mesh_.positions[v[0]],
                                           mesh_.positions[v[2]] - mesh_.positions[v[0]]);
            for (int corner = 0; corner < 3; ++corner) means[v[corner] - firstVertex] += n;
        }
        for (size_t k = firstVertex; k < mesh_.normals.size(); ++k) {
            glm::vec3& n = mesh_.normals[k];
            if (!(glm::length(n) > 1e-12f && std::isfinite(glm::length(n)))) n = means[k - firstVertex];
            const float size = glm::length(n);
            n = size > 1e-12f && std::isfinite(size) ? n / size : glm::vec3(0, 0, 1);
        }
    }

    /// Display colour, and reflectance: by name if the name is known, else the colour. What a blended material lets
    /// through ends in the dark behind it, so its colour counts by its opacity.
    struct Look
    {
        glm::vec3 albedo;
        glm::dvec4 rho;
        bool glass;
    };
    Look materialOf(int index) const
    {
        glm::dvec3 color(0.5);
        std::optional<glm::dvec4> known;
        bool glass = false;
        if (index >= 0 && size_t(index) < model_.materials.size()) {
            const tinygltf::Material& material = model_.materials[size_t(index)];
            const std::vector<double>& factor = material.pbrMetallicRoughness.baseColorFactor;
            if (factor.size() == 4)
                color = glm::dvec3(factor[0], factor[1], factor[2]) * (material.alphaMode == "BLEND" ? factor[3] : 1.0);
            known = findMaterial(material.name);
            glass = material.name == "glass";
        }
        for (int k = 0; k < 3; ++k) color[k] = color[k] > 0.0 ? std::min(color[k], 1.0) : 0.0;
        return {glm::vec3(color), known.value_or(glm::dvec4(color, solarFromRgb(color))), glass};
    }

    bool elements(int index, int type, int componentType, Elements& result)
    {
        if (index < 0 || size_t(index) >= model_.accessors.size())
            return fail(concat("accessor ", index, " does not exist"));
        const tinygltf::Accessor& accessor = model_.accessors[size_t(index)];
        if (accessor.sparse.isSparse) return fail(concat("accessor ", index, " is sparse, which is not read"));
        if (accessor.type != type || accessor.componentType != componentType)
            return fail(concat("accessor ", index, " has an unexpected type"));
        if (accessor.bufferView < 0 || size_t(accessor.bufferView) >= model_.bufferViews.size())
            return fail(concat("accessor ", index, " has no buffer view (compressed files are not read)"));
        const tinygltf::BufferView& view = model_.bufferViews[size_t(accessor.bufferView)];
        if (view.buffer < 0 || size_t(view.buffer) >= model_.buffers.size())
            return fail(concat("buffer ", view.buffer, " does not exist"));
        const std::vector<unsigned char>& bytes = model_.buffers[size_t(view.buffer)].data;
        const size_t elementSize = size_t(tinygltf::GetComponentSizeInBytes(u32(componentType))) *
                                   size_t(tinygltf::GetNumComponentsInType(u32(type)));
        result.stride = view.byteStride != 0 ? view.byteStride : elementSize;
        result.count = accessor.count;
        // Every term is bounded by the buffer's size before it is used in a sum or product.
        const bool fits = view.byteOffset <= bytes.size() && view.byteLength <= bytes.size() - view.byteOffset &&
                          accessor.byteOffset <= view.byteLength && result.stride >= elementSize &&
                          result.stride <= 252 + elementSize && result.count <= bytes.size() &&
                          (result.count == 0 ||
                           (result.count - 1) * result.stride + elementSize <= view.byteLength - accessor.byteOffset);
        if (!fits) return fail(concat("accessor ", index, " reaches past the end of its buffer"));
        result.data = bytes.data() + view.byteOffset + accessor.byteOffset;
        return true;
    }

    const tinygltf::Model& model_;
    AssetMesh& mesh_;
    std::string message_;
    std::vector<glm::dvec4> triangleRho_;
    u32 nodeVisits_ = 0;
};

/// Pictures are not used, so none is decoded.
bool skipImage(tinygltf::Image*, const int, std::string*, std::string*, int, int, const unsigned char*, int, void*)
{
    return true;
}

/// Parses the container. The library may throw on malformed JSON.
bool parse(std::span<const std::byte> bytes, tinygltf::Model& model, std::string& message)
{
    try {
        tinygltf::TinyGLTF loader;
        loader.SetImageLoader(skipImage, nullptr);
        std::string warning;
        if (loader.LoadBinaryFromMemory(&model, &message, &warning,
                                        reinterpret_cast<const unsigned char*>(bytes.data()), u32(bytes.size()), ""))
            return true;
    } catch (const std::exception& exception) {
        message = exception.what();
    }
    for (char& c : message)
        if (c == '\n') c = ' ';
    while (!message.empty() && message.back() == ' ') message.pop_back();
    if (message.empty()) message = "not a binary glTF file";
    return false;
}

} // namespace

Result<AssetMesh> loadAsset(const std::filesystem::path& file, const std::string& nameInRule)
{
    const auto bytes = readTextFile(file);
    if (!bytes) return bytes.error();
    return parseAsset(std::as_bytes(std::span(*bytes)), file.string(), nameInRule);
}

Result<AssetMesh> parseAsset(std::span<const std::byte> glb, const std::string& file, const std::string& nameInRule)
{
    const auto bad = [&](const std::string& message) {
        return Error{concat(file, ": cannot be used as an asset: ", message)};
    };
    if (glb.size() < 20 || std::memcmp(glb.data(), "glTF", 4) != 0) return bad("it is not a binary glTF file (.glb)");
    if (glb.size() > (1u << 30)) return bad("it is larger than 1 GiB");
    tinygltf::Model model;
    std::string message;
    if (!parse(glb, model, message)) return bad(message);

    AssetMesh mesh;
    mesh.path = nameInRule;
    Reader reader(model, mesh);
    if (!reader.run()) return bad(reader.message());
    mesh.boxMin = glm::dvec3(INFINITY);
    mesh.boxMax = glm::dvec3(-INFINITY);
    for (const u32 index : mesh.indices) {
        mesh.boxMin = glm::min(mesh.boxMin, glm::dvec3(mesh.positions[index]));
        mesh.boxMax = glm::max(mesh.boxMax, glm::dvec3(mesh.positions[index]));
    }
    mesh.rho = frontViewReflectance(mesh, reader.triangleRho());
    return mesh;
}

Result<std::filesystem::path> findAsset(const std::string& nameInRule,
                                        const std::vector<std::filesystem::path>& folders)
{
    const std::filesystem::path name(nameInRule);
    std::string looked;
    // A rule file may come from anyone: it must not reach out of the asset folders.
    bool inside = !nameInRule.empty() && name.is_relative();
    for (const std::filesystem::path& part : name) inside = inside && part != "..";
    if (!inside) return Error{concat("the asset '", nameInRule, "' must be a relative path without '..'")};
    for (const std::filesystem::path& folder : folders) {
        std::error_code error;
        if (std::filesystem::is_regular_file(folder / name, error)) return folder / name;
        looked += concat(looked.empty() ? "" : ", ", (folder / name).string());
    }
    return Error{concat("the asset '", nameInRule, "' was not found; looked for ",
                        looked.empty() ? "it nowhere (no asset folder is set)" : looked)};
}

} // namespace helio
