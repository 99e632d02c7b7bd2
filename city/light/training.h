// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>

#include "city/light/sky.h"

namespace helio {

/// Radiosity of every node under a set of lights: what the oracle weighs the error of a link with. Lights: suns spread
/// over the sky, the uniform sky, a uniform irradiance (so that places no sun reaches count too) and the scene's own
/// emission.
struct Training
{
    u32 lightCount = 0;
    std::vector<float> radiosity; ///< [node * lightCount + light], each light scaled to an area mean of 1
    std::vector<float> power;     ///< per node: mean over the lights of the squared radiosity
    std::vector<float> variance;  ///< per node: mean over the lights of the variance inside the node

    std::span<const float> of(u32 node) const { return {radiosity.data() + size_t(node) * lightCount, lightCount}; }
};

/// First-hand light only, broadband channel; `suns` suns of elevations 8 to 75 degrees, equal steps of the sine,
/// azimuths by the golden angle, 4 shadow rays a patch and sun. `sky` is the sky view factor of each patch.
Training trainLights(const NodeTree& tree, const Visibility& visibility, std::span<const float> sky, u32 suns,
                     u32 jobs);

} // namespace helio
