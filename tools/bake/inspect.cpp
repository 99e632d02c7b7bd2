// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/inspect.h"

#include <algorithm>
#include <cstdio>

#include "city/format/pack.h"
#include "city/format/sections.h"
#include "city/pack/stats_text.h"

namespace helio {
namespace {

/// Fraction of a patch's hemisphere that its links, its ancestors' links and the sky account for.
double rowSum(const TileView& tile, u32 patch)
{
    double sum = 0.0;
    for (u32 node = patch; node != gpu::kNone; node = tile.nodes[node].parent)
        for (u32 k = tile.linkRows[node]; k < tile.linkRows[node + 1]; ++k) sum += double(tile.linkFactors[k]);
    for (u32 k = tile.skyRows[patch]; k < tile.skyRows[patch + 1]; ++k) sum += double(tile.skyFactors[k]);
    return sum;
}

} // namespace

Status printInfo(const std::filesystem::path& folder)
{
    const Result<Pack> pack = Pack::open(folder);
    if (!pack) return pack.error();
    const PackIndex& index = pack->index();
    const TileView& tile = pack->tile();
    std::printf("%s: pack of version %u\n", folder.c_str(), index.version);
    std::printf("  source      %s (hash %016llx), seed %llu\n", index.source.c_str(),
                static_cast<unsigned long long>(index.inputHash), static_cast<unsigned long long>(index.seed));
    if (!index.rules.empty())
        std::printf("  rules       %s (hash %016llx)\n", index.rules.c_str(),
                    static_cast<unsigned long long>(index.rulesHash));
    std::printf("  method      %s %s\n", index.method.c_str(), index.options.c_str());
    std::printf("  place       latitude %g, longitude %g, north %g deg, CRS %s, origin %.3f %.3f %.3f m\n",
                index.latitudeDeg, index.longitudeDeg, index.northDeg,
                index.crs.empty() ? "not stated" : index.crs.c_str(), index.origin.x, index.origin.y, index.origin.z);
    std::printf("  bounds      %.2f %.2f %.2f to %.2f %.2f %.2f m\n", double(index.boundsMin.x),
                double(index.boundsMin.y), double(index.boundsMin.z), double(index.boundsMax.x),
                double(index.boundsMax.y), double(index.boundsMax.z));
    std::printf("  buildings   %zu\n  patches     %u\n  nodes       %u\n", splitNames(tile.buildingIds).size(),
                pack->patchCount(), pack->nodeCount());
    std::printf("  links       %zu, %.1f per patch, %s senders\n", tile.linkColumns.size(),
                double(tile.linkColumns.size()) / double(pack->patchCount()),
                tile.linkMoments.empty() ? "constant" : "linear");
    std::printf("  link bytes  %s\n", linkBytesText(pack->linkBytes(), tile.linkColumns.size()).c_str());
    std::printf("  sky         %zu patches, %zu links\n", tile.skyPatches.size(), tile.skyColumns.size());
    std::printf("  drawn       %zu draws, %zu instances, %zu vertices, %zu indices\n", tile.draws.size(),
                tile.instances.size(), tile.vertices.size(), tile.indices.size());
    size_t bytes = 0;
    forEachSection(tile, [&](SectionId, const char*, const auto& span) { bytes += span.size_bytes(); });
    std::printf("  sections    %.1f MiB\n", double(bytes) / 1048576.0);
    return Nothing{};
}

Status verifyPack(const std::filesystem::path& folder)
{
    const Result<Pack> pack = Pack::open(folder);
    if (!pack) return pack.error();
    double least = 1e300, most = 0.0, mean = 0.0, area = 0.0;
    for (u32 i = 0; i < pack->patchCount(); ++i) {
        const double sum = rowSum(pack->tile(), i), patchArea = double(pack->tile().patches[i].area);
        least = std::min(least, sum);
        most = std::max(most, sum);
        mean += patchArea * sum;
        area += patchArea;
    }
    std::printf("%s: good; %u patches, %u nodes, %zu links; links + sky per patch: min %.4f, mean %.4f, max %.4f\n",
                folder.c_str(), pack->patchCount(), pack->nodeCount(), pack->tile().linkColumns.size(), least,
                mean / area, most);
    return Nothing{};
}

} // namespace helio
