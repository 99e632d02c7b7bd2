// SPDX-License-Identifier: Apache-2.0
#include "tests/support/unpack_links.h"

#include <array>
#include <bit>
#include <cmath>

namespace helio::twin {

namespace {

/// Value of a factor's code, from its description in shaders/shared/solve.h.
double factorOf(u32 code, u32 bits)
{
    const double mantissas = std::pow(2.0, double(bits) - 5.0);
    const double exponent = std::floor(code / mantissas), mantissa = code / mantissas - exponent;
    return exponent == 0.0 ? 0.0 : (1.0 + mantissa) * std::pow(2.0, exponent - 31.0);
}

double momentPart(u32 word, u32 byte)
{
    return double(std::int8_t(u8(word >> (8 * byte)))) / 127.0 * double(gpu::kMomentLimit);
}

} // namespace

std::vector<std::vector<UnpackedLink>> unpackLinks(const PackedLinks& packed, u32 receiverCount, u32 patchCount)
{
    std::vector<std::vector<UnpackedLink>> rows(receiverCount);
    for (size_t row = 0; row < packed.rows.size(); ++row) {
        const u32 receiver = packed.rows[row].receiver;
        if (receiver == kNoIndex) continue;
        const gpu::StripRecord& strip = packed.strips[row / gpu::kStripRows];
        const u32 lane = u32(row % gpu::kStripRows);
        for (u32 n = 0; n < strip.patchRecords + strip.innerRecords; ++n) {
            const bool inner = n >= strip.patchRecords;
            const auto quad =
                std::bit_cast<std::array<u32, 4>>(packed.records[strip.begin + n * gpu::kStripRows + lane]);
            for (u32 j = 0; j < 4; ++j) {
                UnpackedLink link{0, factorOf(quad[j] % (1u << packed.factorBits), packed.factorBits), 0.0, 0.0, false};
                if (link.factor == 0.0) continue;
                link.column = (quad[j] >> packed.factorBits) + (inner ? strip.innerBase + patchCount : strip.patchBase);
                if (inner) {
                    const u32 at = strip.momentBegin + (n - strip.patchRecords) * gpu::kStripRows + lane;
                    const auto words = std::bit_cast<std::array<u32, 2>>(packed.moments[at]);
                    link.momentX = link.factor * momentPart(words[j / 2], 2 * (j % 2));
                    link.momentY = link.factor * momentPart(words[j / 2], 2 * (j % 2) + 1);
                }
                rows[receiver].push_back(link);
            }
        }
        for (u32 n = 0; n < strip.singleRecords; ++n) {
            const u32 at = strip.begin + (strip.patchRecords + strip.innerRecords + n) * gpu::kStripRows + lane;
            const auto link = std::bit_cast<gpu::LinkSingleRecord>(packed.records[at]);
            if (link.factor != 0.0f || link.momentX != 0.0f || link.momentY != 0.0f)
                rows[receiver].push_back(
                    {link.column, double(link.factor), double(link.momentX), double(link.momentY), true});
        }
    }
    return rows;
}

} // namespace helio::twin
