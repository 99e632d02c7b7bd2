// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <glm/vec4.hpp>

#include "city/format/pack.h"
#include "engine/view/renderer.h"

namespace helio {

/// Where the light of a solve comes from and where it goes, W, a channel; sums over the patches in double.
struct EnergyAudit
{
    glm::dvec4 sun{0.0}, sky{0.0}, emission{0.0}; ///< A E_sun, A E_sky, A M
    glm::dvec4 absorbed{0.0};                     ///< A (1 - rho) (E_sun + E_sky + E_indirect)
    glm::dvec4 toSky{0.0};                        ///< A B x sum of the patch's sky links
    glm::dvec4 away{0.0};                         ///< A B x the rest: 1 - links of the patch and its ancestors - sky

    glm::dvec4 in() const { return sun + sky + emission; }
    glm::dvec4 out() const { return absorbed + toSky + away; }
    /// in - out. Of B = M + rho E it is sum A (B x link sum - E_indirect): what patches send to patches less what
    /// arrives. It holds the residual of the sweeps and the links' want of reciprocity, A_i F_ij against A_j F_ji. A
    /// link sum that is wrong goes unseen into `away`, which in a closed scene should be nothing.
    glm::dvec4 unexplained() const { return in() - out(); }
    /// The same over in(); 0 where nothing comes in.
    glm::dvec4 unexplainedShare() const;
};

/// emission: did the patches emit (LightState::emission)?
EnergyAudit auditEnergy(const TileView& tile, const LightTables& light, bool emission);

} // namespace helio
