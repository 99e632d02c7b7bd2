// SPDX-License-Identifier: Apache-2.0
#include "tests/support/smooth_twin.h"

#include <algorithm>
#include <cmath>
#include <glm/common.hpp>
#include <limits>

namespace helio::twin {

namespace {

using Weights = std::span<const gpu::CornerWeightRecord>;

Weights weightsOf(const std::vector<gpu::CornerWeightRecord>& weights, const std::vector<u32>& rows, size_t row)
{
    return Weights(weights).subspan(rows[row], rows[row + 1] - rows[row]);
}

} // namespace

std::vector<glm::dvec4> smoothLight(const SmoothMesh& mesh, std::span<const glm::dvec4> means)
{
    const size_t patchCount = means.size(), fanCount = mesh.fanWeightRows.size() - 1;
    std::vector<glm::dvec4> values(mesh.cornerCount + patchCount + fanCount, glm::dvec4(0.0));
    glm::dvec4* const middles = values.data() + mesh.cornerCount;
    glm::dvec4* const fans = middles + patchCount;
    for (size_t p = 0; p < patchCount; ++p) middles[p] = 3.0 * means[p]; // as if all corners were dark
    for (u32 round = 0; round < gpu::kSmoothRounds; ++round) {
        for (u32 c = 0; c < mesh.cornerCount; ++c) {
            const auto begin = mesh.cornerPatches.begin() + mesh.cornerRows[c];
            const auto end = mesh.cornerPatches.begin() + mesh.cornerRows[c + 1];
            glm::dvec4 move(0.0), least(std::numeric_limits<double>::infinity());
            for (auto p = begin; p != end; ++p) {
                move += 0.5 * (middles[*p] - means[*p]) / double(end - begin);
                least = glm::min(least, means[*p]);
            }
            values[c] = glm::clamp(values[c] + move, glm::dvec4(0.0), double(gpu::kSmoothLimit) * glm::max(least, 0.0));
        }
        for (size_t p = 0; p < patchCount; ++p) {
            middles[p] = means[p];
            for (const auto& [corner, weight] : weightsOf(mesh.patchWeights, mesh.patchRows, p))
                middles[p] += double(weight) * (means[p] - values[corner]);
            middles[p] = glm::max(middles[p], glm::dvec4(0.0)); // below by the rounding of the weights
        }
    }
    for (size_t p = 0; p < patchCount; ++p) {
        glm::dvec4 least(0.0);
        for (u32 f = mesh.fanRows[p]; f < mesh.fanRows[p + 1]; ++f) {
            const Weights weights = weightsOf(mesh.fanWeights, mesh.fanWeightRows, f);
            fans[f] = weights.empty() ? glm::dvec4(0.0) : 0.5 * (middles[p] - means[p]);
            for (const auto& [corner, weight] : weights) fans[f] += double(weight) * (values[corner] - means[p]);
            least = glm::min(least, fans[f]);
        }
        const glm::dvec4 turn = glm::min(middles[p] / glm::max(-least, glm::dvec4(1e-30)), glm::dvec4(1.0));
        for (u32 f = mesh.fanRows[p]; f < mesh.fanRows[p + 1]; ++f)
            fans[f] =
                weightsOf(mesh.fanWeights, mesh.fanWeightRows, f).empty() ? means[p] : middles[p] + turn * fans[f];
    }
    return values;
}

std::vector<glm::dvec4> randomMeans(Random& random, size_t count)
{
    std::vector<glm::dvec4> means(count);
    for (glm::dvec4& mean : means)
        mean = {100 + random.uniform(), 100 * random.uniform(), std::pow(10.0, 4 * random.uniform()),
                std::floor(2 * random.uniform())};
    return means;
}

} // namespace helio::twin
