// SPDX-License-Identifier: Apache-2.0
#include "city/light/paper_links.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <glm/geometric.hpp>
#include <limits>
#include <numbers>

#include "city/base/check.h"

namespace helio {
namespace {

struct Box
{
    glm::dvec3 low{std::numeric_limits<double>::max()}, high{std::numeric_limits<double>::lowest()};
};

double distance(const Box& a, const Box& b)
{
    return glm::length(glm::max(glm::max(a.low - b.high, b.low - a.high), glm::dvec3(0.0)));
}

class PaperLinker
{
public:
    PaperLinker(const NodeTree& tree, const PaperOptions& options)
        : tree_(tree), options_(options), box_(tree.nodeCount())
    {
        for (u32 i = 0; i < tree.nodeCount(); ++i) {
            for (const Ring3& ring : tree.outlineOf(i)) {
                for (const glm::dvec3& corner : ring) {
                    box_[i].low = glm::min(box_[i].low, corner);
                    box_[i].high = glm::max(box_[i].high, corner);
                }
            }
        }
    }

    std::vector<NodeLink> run()
    {
        std::vector<u32> roots;
        for (u32 i = 0; i < tree_.nodeCount(); ++i)
            if (tree_.isPlanarRoot(i) && !tree_.nodes[i].covered) roots.push_back(i);
        // Swept along x: only roots whose boxes come within the cut-off there meet. Boxes bound the centroids too.
        std::sort(roots.begin(), roots.end(),
                  [&](u32 a, u32 b) { return box_[a].low.x != box_[b].low.x ? box_[a].low.x < box_[b].low.x : a < b; });
        for (size_t i = 0; i < roots.size(); ++i) {
            for (size_t j = i + 1; j < roots.size(); ++j) {
                if (options_.cutoff > 0.0 && box_[roots[j]].low.x > box_[roots[i]].high.x + options_.cutoff) break;
                findLinks(std::min(roots[i], roots[j]), std::max(roots[i], roots[j]));
            }
        }
        return std::move(links_);
    }

private:
    double separation(u32 a, u32 b) const
    {
        return options_.literal ? glm::distance(tree_.nodes[a].centroid, tree_.nodes[b].centroid)
                                : distance(box_[a], box_[b]);
    }

    void findLinks(u32 a, u32 b)
    {
        if (options_.cutoff > 0.0 && separation(a, b) > options_.cutoff) return;
        const double fab = discFactor(tree_.nodes[a], tree_.nodes[b]), fba = discFactor(tree_.nodes[b], tree_.nodes[a]);
        bool splitA = false, splitB = false;
        if (options_.literal) {
            splitA = fab > options_.epsilon;
            splitB = !splitA && fba > options_.epsilon;
        } else if (std::max(fab, fba) > options_.epsilon) {
            // Large F_ab: b is large as seen from a.
            splitB = fab >= fba;
            splitA = !splitB;
            if (splitB && tree_.isLeaf(b)) std::swap(splitA, splitB);
            if (splitA && tree_.isLeaf(a)) std::swap(splitA, splitB);
            if (tree_.isLeaf(a) && tree_.isLeaf(b)) splitA = splitB = false;
        }
        if (splitA) {
            for (const u32 child : tree_.childrenOf(a)) findLinks(child, b);
        } else if (splitB) {
            for (const u32 child : tree_.childrenOf(b)) findLinks(a, child);
        } else if (fab > 0.0) {
            links_.push_back({.receiver = a, .sender = b, .factor = float(fab)});
            links_.push_back({.receiver = b, .sender = a, .factor = float(fba)});
        }
    }

    const NodeTree& tree_;
    PaperOptions options_;
    std::vector<Box> box_;
    std::vector<NodeLink> links_;
};

} // namespace

double discFactor(const Node& from, const Node& to)
{
    const glm::dvec3 d = to.centroid - from.centroid;
    const double d2 = glm::dot(d, d), a = glm::dot(from.normal, d), b = -glm::dot(to.normal, d);
    if (a <= 0.0 || b <= 0.0) return 0.0;
    return to.area * a * b / d2 / (std::numbers::pi * d2 + to.area);
}

std::vector<NodeLink> paperLinks(const NodeTree& tree, const PaperOptions& options)
{
    HELIO_CHECK(options.epsilon > 0.0 && options.cutoff >= 0.0, "epsilon = ", options.epsilon,
                ", cutoff = ", options.cutoff);
    return PaperLinker(tree, options).run();
}

} // namespace helio
