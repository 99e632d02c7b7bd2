// SPDX-License-Identifier: Apache-2.0
#include "city/light/reference_solver.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "city/base/check.h"
#include "city/light/linear_senders.h"

namespace helio {
namespace {

double largest(const glm::dvec4& v)
{
    return std::max(std::max(v.x, v.y), std::max(v.z, v.w));
}

/// Radiosity of every node; with linear senders two slopes a node too.
struct NodeLight
{
    std::vector<glm::dvec4> mean, slopeX, slopeY;
};

/// Gathers at every node, then hands irradiance down: afterwards every leaf holds its whole indirect irradiance.
void gather(const NodeTree& tree, const LinkTable& links, const NodeLight& light, bool own,
            std::vector<glm::dvec4>& irradiance)
{
    const bool linear = !links.moment.empty();
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        glm::dvec4 sum(0.0);
        for (u32 k = links.rowBegin[i]; k < links.rowBegin[i + 1]; ++k) {
            const u32 sender = own ? i : links.column[k];
            sum += double(links.factor[k]) * light.mean[sender];
            if (linear)
                sum +=
                    double(links.moment[k].x) * light.slopeX[sender] + double(links.moment[k].y) * light.slopeY[sender];
        }
        irradiance[i] = sum;
    }
    for (u32 i = tree.nodeCount(); i-- > 0;)
        if (const u32 parent = tree.nodes[i].parent; parent != kNoIndex) irradiance[i] += irradiance[parent];
}

/// Flux comes up, and with it the slopes: children have smaller numbers than their parents.
void pullUp(const NodeTree& tree, const LinkTable& links, NodeLight& light)
{
    for (u32 i = tree.patchCount(); i < tree.nodeCount(); ++i) {
        const Node& node = tree.nodes[i];
        glm::dvec4 flux(0.0), x(0.0), y(0.0);
        for (u32 k = node.childBegin; k < node.childBegin + node.childCount; ++k) {
            const u32 child = tree.children[k];
            const double area = tree.nodes[child].area;
            flux += area * light.mean[child];
            if (light.slopeX.empty()) continue;
            const gpu::ChildSlopeRecord& s = links.childSlopes[k];
            x += area * (double(s.offsetX) * light.mean[child] + double(s.xx) * light.slopeX[child] +
                         double(s.xy) * light.slopeY[child]);
            y += area * (double(s.offsetY) * light.mean[child] + double(s.yx) * light.slopeX[child] +
                         double(s.yy) * light.slopeY[child]);
        }
        light.mean[i] = flux / node.area;
        if (light.slopeX.empty()) continue;
        light.slopeX[i] = x / node.area;
        light.slopeY[i] = y / node.area;
    }
}

} // namespace

std::vector<double> patchRowSums(const NodeTree& tree, const LinkTable& links)
{
    std::vector<double> sum(tree.nodeCount(), 0.0);
    for (u32 i = tree.nodeCount(); i-- > 0;) {
        for (u32 k = links.rowBegin[i]; k < links.rowBegin[i + 1]; ++k) sum[i] += double(links.factor[k]);
        if (const u32 parent = tree.nodes[i].parent; parent != kNoIndex) sum[i] += sum[parent];
    }
    sum.resize(tree.patchCount());
    return sum;
}

Solution solveLight(const NodeTree& tree, const LinkTable& links, std::span<const glm::dvec4> sun,
                    std::span<const glm::dvec4> sky, const SolveOptions& options)
{
    const u32 count = tree.patchCount();
    HELIO_CHECK(sun.size() == count && sky.size() == count, count, " patches, ", sun.size(), " sun, ", sky.size(),
                " sky values");
    HELIO_CHECK(links.rowBegin.size() == tree.nodeCount() + 1, links.rowBegin.size(), " rows for ", tree.nodeCount(),
                " nodes");
    std::vector<glm::dvec4> first(count);
    for (u32 i = 0; i < count; ++i) {
        const Patch& patch = tree.patches[i];
        const glm::dvec4 incident = sun[i] + sky[i];
        first[i] = options.rule == UpdateRule::EnergyAsRadiosity ? patch.emission + patch.area * incident
                                                                 : patch.emission + patch.rho * incident;
    }
    glm::dvec4 contraction(0.0);
    const std::vector<double> rowSum = patchRowSums(tree, links);
    for (u32 i = 0; i < count; ++i) contraction = glm::max(contraction, tree.patches[i].rho * rowSum[i]);

    HELIO_CHECK(links.moment.empty() ||
                    (links.moment.size() == links.column.size() && links.childSlopes.size() == tree.children.size()),
                links.moment.size(), " moments and ", links.childSlopes.size(), " child slopes for ",
                links.column.size(), " links");
    Solution solution;
    NodeLight light;
    std::vector<glm::dvec4>& radiosity = light.mean;
    radiosity.resize(tree.nodeCount());
    if (!links.moment.empty()) {
        light.slopeX.assign(tree.nodeCount(), glm::dvec4(0.0));
        light.slopeY = light.slopeX;
    }
    std::copy(first.begin(), first.end(), radiosity.begin());
    pullUp(tree, links, light);
    std::vector<glm::dvec4> irradiance(tree.nodeCount());
    for (u32 k = 0; k < options.maxSweeps; ++k) {
        gather(tree, links, light, options.rule == UpdateRule::OwnRadiosity, irradiance);
        double changed = 0.0, reflected = 0.0;
        glm::dvec4 largestChange(0.0), squares(0.0);
        for (u32 i = 0; i < count; ++i) {
            const Patch& patch = tree.patches[i];
            const glm::dvec4 base = options.rule == UpdateRule::NeverReset ? radiosity[i] : first[i];
            const glm::dvec4 next = base + patch.rho * irradiance[i], change = next - radiosity[i],
                             rise = next - first[i];
            for (u32 c = 0; c < 4; ++c) {
                changed += patch.area * change[c] * change[c];
                reflected += patch.area * rise[c] * rise[c];
            }
            squares += change * change;
            largestChange = glm::max(largestChange, glm::abs(change));
            radiosity[i] = next;
        }
        pullUp(tree, links, light);
        Sweep sweep;
        sweep.residual = reflected > 0.0 ? std::sqrt(changed / reflected) : 0.0;
        sweep.paperError = std::sqrt(largest(squares));
        for (u32 c = 0; c < 4; ++c) {
            const double q = contraction[c];
            sweep.bound = std::max(sweep.bound, q < 1.0 ? largestChange[c] * q / (1.0 - q)
                                                        : std::numeric_limits<double>::infinity());
        }
        solution.sweeps.push_back(sweep);
        if (sweep.residual <= options.residual) break;
    }
    gather(tree, links, light, options.rule == UpdateRule::OwnRadiosity, irradiance);
    solution.indirect.assign(irradiance.begin(), irradiance.begin() + count);
    solution.radiosity = std::move(light.mean);
    return solution;
}

std::vector<double> denseFactors(const NodeTree& tree, const LinkTable& links)
{
    const u32 n = tree.patchCount();
    const std::vector<SlopeFrame> frames = slopeFrames(tree);
    // Patches below each node.
    std::vector<std::vector<u32>> below(tree.nodeCount());
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        if (tree.isLeaf(i)) below[i] = {i};
        for (const u32 child : tree.childrenOf(i))
            below[i].insert(below[i].end(), below[child].begin(), below[child].end());
    }
    std::vector<double> dense(size_t(n) * n, 0.0);
    for (u32 i = 0; i < tree.nodeCount(); ++i) {
        for (u32 k = links.rowBegin[i]; k < links.rowBegin[i + 1]; ++k) {
            const u32 sender = links.column[k];
            for (const u32 s : below[sender]) {
                double factor = double(links.factor[k]);
                if (!links.moment.empty())
                    factor += glm::dot(glm::dvec2(links.moment[k]),
                                       frames[sender].at(tree.nodes[s].centroid - tree.nodes[sender].centroid));
                factor *= tree.nodes[s].area / tree.nodes[sender].area;
                for (const u32 r : below[i]) dense[size_t(r) * n + s] += factor;
            }
        }
    }
    return dense;
}

std::vector<double> solveDense(std::span<const double> factors, std::span<const double> rho, std::span<const double> b0)
{
    const size_t n = b0.size();
    HELIO_CHECK(factors.size() == n * n && rho.size() == n, n, " unknowns, ", factors.size(), " factors, ", rho.size(),
                " reflectances");
    std::vector<double> m(n * n), x(b0.begin(), b0.end());
    for (size_t i = 0; i < n; ++i)
        for (size_t j = 0; j < n; ++j) m[i * n + j] = (i == j ? 1.0 : 0.0) - rho[i] * factors[i * n + j];
    for (size_t k = 0; k < n; ++k) {
        size_t pivot = k;
        for (size_t i = k + 1; i < n; ++i)
            if (std::abs(m[i * n + k]) > std::abs(m[pivot * n + k])) pivot = i;
        HELIO_CHECK(m[pivot * n + k] != 0.0, "singular matrix at column ", k);
        for (size_t j = 0; pivot != k && j < n; ++j) std::swap(m[k * n + j], m[pivot * n + j]);
        std::swap(x[k], x[pivot]);
        for (size_t i = k + 1; i < n; ++i) {
            const double f = m[i * n + k] / m[k * n + k];
            if (f == 0.0) continue;
            for (size_t j = k; j < n; ++j) m[i * n + j] -= f * m[k * n + j];
            x[i] -= f * x[k];
        }
    }
    for (size_t k = n; k-- > 0;) {
        for (size_t j = k + 1; j < n; ++j) x[k] -= m[k * n + j] * x[j];
        x[k] /= m[k * n + k];
    }
    return x;
}

} // namespace helio
