// SPDX-License-Identifier: Apache-2.0
#include "engine/view/energy_audit.h"

#include "city/base/check.h"
#include "engine/stream/contraction.h"

namespace helio {

glm::dvec4 EnergyAudit::unexplainedShare() const
{
    const glm::dvec4 all = in(), missing = unexplained();
    glm::dvec4 share(0.0);
    for (int c = 0; c < 4; ++c)
        if (all[c] > 0.0) share[c] = missing[c] / all[c];
    return share;
}

EnergyAudit auditEnergy(const TileView& tile, const LightTables& light, bool emission)
{
    const size_t count = tile.patches.size();
    HELIO_CHECK(light.sun.size() == count && light.sky.size() == count && light.indirect.size() == count &&
                    light.radiosity.size() == count,
                count, " patches, ", light.radiosity.size(), " radiosities");
    const std::vector<double> toPatches = linkSums(tile);
    EnergyAudit audit;
    for (size_t i = 0; i < count; ++i) {
        const gpu::PatchRecord& patch = tile.patches[i];
        const double area = double(patch.area);
        const glm::dvec4 sun(light.sun[i]), sky(light.sky[i]), sent = area * glm::dvec4(light.radiosity[i]);
        audit.sun += area * sun;
        audit.sky += area * sky;
        if (emission) audit.emission += area * glm::dvec4(patch.emission);
        audit.absorbed += area * (1.0 - glm::dvec4(patch.rho)) * (sun + sky + glm::dvec4(light.indirect[i]));
        double toSky = 0.0;
        for (u32 k = tile.skyRows[i]; k < tile.skyRows[i + 1]; ++k) toSky += double(tile.skyFactors[k]);
        audit.toSky += toSky * sent;
        audit.away += (1.0 - toPatches[i] - toSky) * sent;
    }
    return audit;
}

} // namespace helio
