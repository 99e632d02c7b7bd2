// SPDX-License-Identifier: Apache-2.0
#include "city/pack/export.h"

#include <algorithm>
#include <charconv>

#include "city/base/file.h"
#include "city/model/node_tree.h"
#include "city/pack/patch_scene.h"
#include "city/pack/single_ring.h"

namespace helio {
namespace {

constexpr u32 kClusterKind = u32(NodeKind::Cluster);

/// The shortest text that reads back as the same number.
template <class T> void append(std::string& text, T value)
{
    char digits[32];
    const auto [end, failure] = std::to_chars(digits, digits + sizeof digits, value);
    HELIO_CHECK(failure == std::errc{}, value);
    text.append(digits, end);
}

/// A name that keeps the columns of a CSV row apart.
std::string plainName(std::string name)
{
    for (char& c : name)
        if (c == ',' || c == '"' || c == '\n' || c == '\r') c = '_';
    return name.empty() ? "surface" : name;
}

/// The path of every patch: ordinals of its planar root inside its building, and of the next two levels.
class PatchPaths
{
public:
    explicit PatchPaths(const TileView& tile) : tile_(tile), ordinal_(tile.nodes.size(), kNoIndex), rootsOf_(1, 0u)
    {
        // Children know their place among their siblings from the list; planar roots are counted as their first patch
        // comes up.
        for (u64 i = tile.patches.size(); i < tile.nodes.size(); ++i)
            for (u32 k = 0; k < tile.nodes[i].childCount; ++k)
                if (tile.nodeInfos[i].kind != kClusterKind) ordinal_[tile.children[tile.nodes[i].childBegin + k]] = k;
    }

    struct Path
    {
        u32 facade = 0, floor = 0, bay = 0;
    };
    Path next(u32 patch)
    {
        u32 chain[3] = {kNoIndex, kNoIndex, patch}; // the three highest planar nodes over the patch, the root last
        u32 node = patch;
        while (true) {
            const u32 parent = tile_.nodes[node].parent;
            if (parent == gpu::kNone || tile_.nodeInfos[parent].kind == kClusterKind) break;
            node = parent;
            chain[0] = chain[1];
            chain[1] = chain[2];
            chain[2] = node;
        }
        const u32 building = tile_.patches[patch].building;
        const size_t slot = building == gpu::kNone ? 0 : size_t(building) + 1;
        if (ordinal_[node] == kNoIndex) {
            if (slot >= rootsOf_.size()) rootsOf_.resize(slot + 1, 0u);
            ordinal_[node] = rootsOf_[slot]++;
        }
        const auto ordinalOf = [&](u32 n) { return n == kNoIndex ? 0u : ordinal_[n]; };
        return {ordinalOf(chain[2]), ordinalOf(chain[1]), ordinalOf(chain[0])};
    }

private:
    const TileView& tile_;
    std::vector<u32> ordinal_; ///< of planar nodes below their parent, of planar roots inside their building
    std::vector<u32> rootsOf_; ///< planar roots counted so far, slot 0 = ground, slot i + 1 = building i
};

void appendFace(std::string& obj, const Ring3& ring)
{
    for (const glm::dvec3& q : ring) {
        obj += "v ";
        append(obj, q.x);
        obj += ' ';
        append(obj, q.y);
        obj += ' ';
        append(obj, q.z);
        obj += '\n';
    }
    obj += 'f';
    for (size_t corner = ring.size(); corner > 0; --corner) {
        obj += " -";
        append(obj, corner);
    }
    obj += '\n';
}

} // namespace

SurfaceText exportSurfaces(const Pack& pack)
{
    const TileView& tile = pack.tile();
    std::vector<std::string> kinds = splitNames(tile.surfaceNames);
    for (std::string& kind : kinds) kind = plainName(std::move(kind));
    SurfaceText text;
    text.obj = "# z up, metres; face k (0-based, file order) = patch k = row k of the CSV file\n";
    text.csv = "kind,building,facade,floor,bay,rho_r,rho_g,rho_b,rho_solar,emit_r,emit_g,emit_b,emit_solar\n";
    PatchPaths paths(tile);
    for (u32 i = 0; i < pack.patchCount(); ++i) {
        const gpu::PatchRecord& patch = tile.patches[i];
        appendFace(text.obj, joinRings(outlineRings(tile, i), patch.normal));

        const PatchPaths::Path path = paths.next(i);
        text.csv += patch.surface == gpu::kNone ? "surface" : kinds[patch.surface];
        text.csv += ',';
        append(text.csv, patch.building == gpu::kNone ? i64(-1) : i64(patch.building));
        for (const u32 ordinal : {path.facade, path.floor, path.bay}) {
            text.csv += ',';
            append(text.csv, ordinal);
        }
        for (const glm::vec4& quantity : {patch.rho, patch.emission})
            for (int c = 0; c < 4; ++c) {
                text.csv += ',';
                append(text.csv, quantity[c]);
            }
        text.csv += '\n';
    }
    return text;
}

Status writeSurfaces(const Pack& pack, const std::filesystem::path& base)
{
    const SurfaceText text = exportSurfaces(pack);
    std::filesystem::path obj = base, csv = base;
    obj += ".obj";
    csv += ".csv";
    if (Status status = writeTextAtomically(obj, text.obj); !status) return status;
    return writeTextAtomically(csv, text.csv);
}

} // namespace helio
