// SPDX-License-Identifier: Apache-2.0
#include "city/light/reference_solver.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

#include "city/base/check.h"
#include "city/light/light_flow.h"
#include "city/light/linear_senders.h"

namespace helio {
namespace {

double largest(const glm::dvec4& v)
{
    return std::max(std::max(v.x, v.y), std::max(v.z, v.w));
}

/// The paper's misprint: each link brings the receiver's own radiosity.
LinkTable ownLinks(const NodeTree& tree, const LinkTable& links)
{
    LinkTable own = links;
    for (u32 i = 0; i < tree.nodeCount(); ++i)
        for (u32 k = links.rowBegin[i]; k < links.rowBegin[i + 1]; ++k) own.column[k] = i;
    return own;
}

/// Per node, the corners of a box around the slope coordinates of the patches below.
struct SlopeBox
{
    glm::dvec2 low{0.0}, high{0.0};
};

std::vector<SlopeBox> slopeBoxes(const NodeTree& tree)
{
    const std::vector<SlopeFrame> frames = slopeFrames(tree);
    std::vector<SlopeBox> boxes(tree.nodeCount());
    for (u32 patch = 0; patch < tree.patchCount(); ++patch) {
        for (u32 i = tree.nodes[patch].parent; i != kNoIndex; i = tree.nodes[i].parent) {
            const glm::dvec2 at = frames[i].at(tree.nodes[patch].centroid - tree.nodes[i].centroid);
            boxes[i].low = glm::min(boxes[i].low, at);
            boxes[i].high = glm::max(boxes[i].high, at);
        }
    }
    return boxes;
}

/// Per patch, the most irradiance that patches of a radiosity of at most 1 can bring. Where F + M . X is positive all
/// over the sender, a link is a mean with weights that add up to F; else |F B + M . slope| <= sqrt(F^2 + |M|^2), for a
/// sender's squared mean and slopes add up to its mean square at most.
std::vector<double> patchRowNorms(const NodeTree& tree, const LinkTable& links)
{
    if (links.moment.empty()) return patchRowSums(tree, links);
    const std::vector<SlopeBox> boxes = slopeBoxes(tree);
    LinkTable norms;
    norms.rowBegin = links.rowBegin;
    norms.factor = links.factor;
    for (size_t k = 0; k < norms.factor.size(); ++k) {
        const SlopeBox& box = boxes[links.column[k]];
        const glm::dvec2 moment(links.moment[k]), least = glm::min(moment * box.low, moment * box.high);
        if (double(links.factor[k]) + least.x + least.y < 0.0)
            norms.factor[k] = std::hypot(norms.factor[k], glm::length(links.moment[k]));
    }
    return patchRowSums(tree, norms);
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
    const std::vector<double> norm = patchRowNorms(tree, links);
    for (u32 i = 0; i < count; ++i) contraction = glm::max(contraction, tree.patches[i].rho * norm[i]);

    HELIO_CHECK(links.moment.empty() ||
                    (links.moment.size() == links.column.size() && links.childSlopes.size() == tree.children.size()),
                links.moment.size(), " moments and ", links.childSlopes.size(), " child slopes for ",
                links.column.size(), " links");
    Solution solution;
    NodeLight light = darkLight(tree, links);
    std::vector<glm::dvec4>& radiosity = light.mean;
    std::copy(first.begin(), first.end(), radiosity.begin());
    pullUp(tree, links, light);
    std::vector<glm::dvec4> irradiance;
    LinkTable own;
    if (options.rule == UpdateRule::OwnRadiosity) own = ownLinks(tree, links);
    const LinkTable& gathered = options.rule == UpdateRule::OwnRadiosity ? own : links;
    const auto gather = [&] { gatherLight(tree, gathered, light, 1, irradiance); };
    for (u32 k = 0; k < options.maxSweeps; ++k) {
        gather();
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
    gather();
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
