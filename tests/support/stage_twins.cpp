// SPDX-License-Identifier: Apache-2.0
#include "tests/support/stage_twins.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>

namespace helio::twin {

std::vector<u32> countIds(std::span<const u32> ids, u32 patchCount)
{
    std::vector<u32> counts(patchCount, 0);
    for (const u32 id : ids)
        if (id < patchCount) ++counts[id];
    return counts;
}

std::vector<RowSum> gather(const TileView& tile, const NodeLight& light)
{
    std::vector<RowSum> rows(tile.nodes.size());
    for (size_t i = 0; i < rows.size(); ++i) {
        const auto add = [&](double factor, const glm::dvec4& value) {
            rows[i].sum += factor * value;
            rows[i].absolute += glm::abs(factor * value);
        };
        for (u32 k = tile.linkRows[i]; k < tile.linkRows[i + 1]; ++k) {
            const u32 sender = tile.linkColumns[k];
            add(double(tile.linkFactors[k]), light.mean[sender]);
            if (tile.linkMoments.empty()) continue;
            add(double(tile.linkMoments[2 * k]), light.slopeX[sender]);
            add(double(tile.linkMoments[2 * k + 1]), light.slopeY[sender]);
        }
    }
    return rows;
}

std::vector<glm::dvec4> pullUp(const TileView& tile, std::span<const glm::dvec4> values)
{
    std::vector<glm::dvec4> out(values.begin(), values.end());
    for (size_t i = values.size(); i < tile.nodes.size(); ++i) {
        glm::dvec4 sum(0.0);
        for (u32 k = 0; k < tile.nodes[i].childCount; ++k) {
            const u32 child = tile.children[tile.nodes[i].childBegin + k];
            sum += double(tile.nodes[child].area) * out[child];
        }
        out.push_back(sum / double(tile.nodes[i].area));
    }
    return out;
}

NodeLight pullLight(const TileView& tile, std::span<const glm::dvec4> values)
{
    NodeLight out;
    out.mean = pullUp(tile, values);
    if (tile.linkMoments.empty()) return out;
    out.slopeX.assign(tile.nodes.size(), glm::dvec4(0.0));
    out.slopeY = out.slopeX;
    for (size_t i = values.size(); i < tile.nodes.size(); ++i) {
        const gpu::NodeRecord& node = tile.nodes[i];
        for (u32 k = node.childBegin; k < node.childBegin + node.childCount; ++k) {
            const u32 child = tile.children[k];
            const gpu::ChildSlopeRecord& s = tile.childSlopes[k];
            const double share = double(tile.nodes[child].area) / double(node.area);
            const glm::dvec4 mean = share * out.mean[child], x = share * out.slopeX[child],
                             y = share * out.slopeY[child];
            out.slopeX[i] += double(s.offsetX) * mean + double(s.xx) * x + double(s.xy) * y;
            out.slopeY[i] += double(s.offsetY) * mean + double(s.yx) * x + double(s.yy) * y;
        }
    }
    return out;
}

std::vector<glm::dvec4> pushDown(const TileView& tile, std::span<const glm::dvec4> values)
{
    std::vector<glm::dvec4> out;
    for (u32 i = 0; i < values.size(); ++i) {
        glm::dvec4 sum = values[i];
        for (u32 up = tile.nodes[i].parent; up != kNoIndex; up = tile.nodes[up].parent) sum += values[up];
        out.push_back(sum);
    }
    return out;
}

SunEnergy sunEnergy(const TileView& tile, std::span<const u32> counts, glm::dvec3 towardsSun, double dni,
                    double texelArea, double minSamples, double minCosine)
{
    // Areas perpendicular to the sun, seen and unoccluded, summed over the patches below each node.
    struct Areas
    {
        double seen = 0.0, alone = 0.0;
    };
    std::vector<Areas> areas(tile.nodes.size());
    for (u32 i = 0; i < tile.patches.size(); ++i) {
        const double cosine = glm::dot(glm::dvec3(tile.patches[i].normal), towardsSun);
        if (cosine <= 0.0) continue;
        for (u32 node = i; node != kNoIndex; node = tile.nodes[node].parent) {
            areas[node].seen += counts[i] * texelArea;
            areas[node].alone += tile.patches[i].area * cosine;
        }
    }
    SunEnergy out;
    for (u32 i = 0; i < tile.patches.size(); ++i) {
        const double cosine = glm::dot(glm::dvec3(tile.patches[i].normal), towardsSun);
        if (cosine <= 0.0) {
            out.irradiance.emplace_back(0.0);
            continue;
        }
        const bool judged = cosine >= minCosine && areas[i].alone >= minSamples * texelArea;
        u32 node = i;
        if (!judged)
            while (tile.nodes[node].parent != kNoIndex) {
                node = tile.nodes[node].parent;
                if (areas[node].alone >= minSamples * texelArea) break;
            }
        const double ratio = areas[node].seen / areas[node].alone;
        out.irradiance.emplace_back(dni * cosine * std::min(1.0, ratio));
        ++out.lit;
        out.flagged += !judged;
        out.excess += judged && ratio > 1.0;
    }
    return out;
}

namespace {

/// T_n(x) of x >= 1.
double chebyshev(u32 n, double x)
{
    return std::cosh(n * std::acosh(x));
}

/// Weight of sweep k by the definition: 2 T_k(1/m) / (m T_(k+1)(1/m)); the first one is plain.
glm::dvec4 weightOf(u32 sweep, const glm::dvec4& radius)
{
    glm::dvec4 weight(1.0);
    for (int c = 0; c < 4; ++c)
        if (sweep > 0 && radius[c] > 0.0)
            weight[c] = 2.0 / radius[c] * chebyshev(sweep, 1.0 / radius[c]) / chebyshev(sweep + 1, 1.0 / radius[c]);
    return weight;
}

} // namespace

Solution solve(const TileView& tile, std::span<const glm::dvec4> b0, u32 sweeps, const glm::dvec4& radius)
{
    Solution s;
    s.radiosity.assign(b0.begin(), b0.end());
    std::vector<glm::dvec4> before = s.radiosity;
    for (u32 sweep = 0; sweep < sweeps; ++sweep) {
        std::vector<glm::dvec4> own;
        for (const RowSum& row : gather(tile, pullLight(tile, s.radiosity))) own.push_back(row.sum);
        s.indirect = pushDown(tile, own);
        s.indirect.resize(b0.size());
        const glm::dvec4 weight = weightOf(sweep, radius);
        glm::dvec4 change(0.0), scale(0.0);
        s.largest = glm::dvec4(0.0);
        for (size_t i = 0; i < b0.size(); ++i) {
            const glm::dvec4 added = glm::dvec4(tile.patches[i].rho) * s.indirect[i];
            const glm::dvec4 step = b0[i] + added - s.radiosity[i];
            change += double(tile.patches[i].area) * step * step;
            scale += double(tile.patches[i].area) * added * added;
            s.largest = glm::max(s.largest, glm::abs(step));
            const glm::dvec4 next = weight * (b0[i] + added) + (1.0 - weight) * before[i];
            before[i] = s.radiosity[i];
            s.radiosity[i] = next;
        }
        s.residual = 0.0;
        for (int c = 0; c < 4; ++c)
            if (scale[c] > 0.0) s.residual = std::max(s.residual, std::sqrt(change[c] / scale[c]));
    }
    return s;
}

} // namespace helio::twin
