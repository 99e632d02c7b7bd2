// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec2.hpp>
#include <span>

#include "city/light/sky.h"
#include "shaders/shared/records.h"

namespace helio {

/// Radiosity of every node under a set of lights, as its mean and, for planar inner nodes, its slope (SlopeFrame): what
/// the oracle weighs the error of a link with. Lights: suns spread over the sky, the uniform sky, a uniform irradiance
/// (so that places no sun reaches count too) and the scene's own emission.
struct Training
{
    u32 lightCount = 0;
    std::vector<float> radiosity;  ///< [node * lightCount + light], each light scaled to an area mean of 1
    std::vector<glm::vec2> slope;  ///< [(node - patches) * lightCount + light]; empty for constant senders
    std::vector<float> power;      ///< per node: mean over the lights of the squared radiosity
    std::vector<float> slopePower; ///< per node: mean over the lights of the squared slope
    /// Per node: mean over the lights of the variance of the radiosity about its mean and slope inside the node.
    std::vector<float> variance;
    u32 patchCount = 0;

    std::span<const float> of(u32 node) const { return {radiosity.data() + size_t(node) * lightCount, lightCount}; }
    /// Empty for a leaf and for constant senders.
    std::span<const glm::vec2> slopeOf(u32 node) const
    {
        if (node < patchCount || slope.empty()) return {};
        return {slope.data() + size_t(node - patchCount) * lightCount, lightCount};
    }
};

/// Unit vectors to suns of elevations 8 to 75 degrees, equal steps of the sine, azimuths by the golden angle.
std::vector<glm::dvec3> trainingSuns(u32 count);

/// First-hand light only, broadband channel; trainingSuns(suns), 4 shadow rays a patch and sun. `sky` is the sky view
/// factor of each patch. `slopes`: childSlopes() of the tree, empty for constant senders.
Training trainLights(const NodeTree& tree, const Visibility& visibility, std::span<const float> sky,
                     std::span<const gpu::ChildSlopeRecord> slopes, u32 suns, u32 jobs);

} // namespace helio
