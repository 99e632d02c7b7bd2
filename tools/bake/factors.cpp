// SPDX-License-Identifier: Apache-2.0
#include "tools/bake/factors.h"

#include <algorithm>
#include <cstdio>

#include "city/base/file.h"
#include "city/base/parallel.h"
#include "city/light/pair_factor.h"
#include "tools/bake/pair_list.h"

namespace helio {

Status writeFactors(const FactorOptions& options)
{
    if (Status status = checkFileTarget(options.output); !status) return status;
    const Result<std::vector<PolygonPair>> pairs = readPolygonPairs(options.pairs);
    if (!pairs) return pairs.error();

    std::vector<PairFactor> factors(pairs->size());
    const PairAccuracy& accuracy = options.reference ? kReferenceAccuracy : kProductionAccuracy;
    parallelFor(u32(pairs->size()), 1, options.jobs, [&](u32 begin, u32 end) {
        for (u32 k = begin; k < end; ++k) {
            const PolygonPair& pair = (*pairs)[k];
            factors[k] = pairFactor(pair.a, pair.b, pair.occluders, accuracy);
        }
    });

    std::string csv = "id,F_ab,F_ba,visibility,error,evaluations\n";
    double worst = 0.0;
    for (size_t k = 0; k < factors.size(); ++k) {
        const PairFactor& f = factors[k];
        // 17 digits give the same double back.
        char row[160];
        std::snprintf(row, sizeof row, ",%.17g,%.17g,%.17g,%.3g,%llu\n", f.ab, f.ba, f.visibility, f.error,
                      static_cast<unsigned long long>(f.evaluations));
        csv += (*pairs)[k].id + row;
        worst = std::max(worst, f.error);
    }
    if (Status written = writeTextAtomically(options.output, csv); !written) return written;
    std::printf("%s: %zu pairs, largest estimated error %.2g\n", options.output.c_str(), factors.size(), worst);
    return Nothing{};
}

} // namespace helio
