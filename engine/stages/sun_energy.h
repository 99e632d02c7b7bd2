// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec3.hpp>
#include <glm/vec4.hpp>

#include "engine/graph/frame_graph.h"
#include "engine/stream/tile_tables.h"

namespace helio {

/// Below this many texels a count says little (its error is near 5 % at 16), and below this cosine it says less still.
inline constexpr float kMinSunSamples = 16.0f;
inline constexpr float kMinSunCosine = 0.02f;

struct SunEnergyInput
{
    glm::vec3 towardsSun{0.0f, 0.0f, 1.0f}; ///< unit
    glm::vec4 dni{0.0f};                    ///< W/m2 a channel
    double texelArea = 1.0;                 ///< m2
    float discRadius = 0.0f;                ///< rad, of the sun's disc on patches that it grazes; 0 = a point
};

struct SunEnergyRefs
{
    Ref<Buffer> irradiance; ///< E_sun, vec4 a patch, W/m2
    Ref<Buffer> tally;      ///< SunTallyRecord
};

/// Stage 2: counts to E_sun = DNI cos(theta) V (city/README.md). Patches with too few samples take the ratio of an
/// ancestor. density: scratch, vec4 a node.
SunEnergyRefs addSunEnergy(FrameGraph& graph, const TileTables& tile, Ref<Buffer> counts, Ref<Buffer> density,
                           SunEnergyRefs to, const SunEnergyInput& input);

} // namespace helio
