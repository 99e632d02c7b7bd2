// SPDX-License-Identifier: Apache-2.0
#include "city/light/sequence.h"

#include "city/base/hash.h"

namespace helio {
namespace {

using Matrix = std::array<std::array<u32, 32>, 4>;

/// Bit k of an index toggles direction[d][k].
constexpr Matrix makeDirections()
{
    Matrix v{};
    for (u32 k = 0; k < 32; ++k) v[0][k] = 1u << (31 - k);
    // degree s, coefficients a, first m of the primitive polynomials of dimensions 2 to 4
    constexpr u32 s[3]{1, 2, 3}, a[3]{0, 1, 1}, m[3][3]{{1, 0, 0}, {1, 3, 0}, {1, 3, 1}};
    for (u32 d = 0; d < 3; ++d) {
        for (u32 k = 0; k < 32; ++k) {
            if (k < s[d]) {
                v[d + 1][k] = m[d][k] << (31 - k);
                continue;
            }
            u32 value = v[d + 1][k - s[d]] ^ (v[d + 1][k - s[d]] >> s[d]);
            for (u32 j = 1; j < s[d]; ++j)
                if ((a[d] >> (s[d] - 1 - j)) & 1u) value ^= v[d + 1][k - j];
            v[d + 1][k] = value;
        }
    }
    return v;
}
constexpr Matrix kDirections = makeDirections();

constexpr std::array<u32, 4> makePoint(u32 index)
{
    std::array<u32, 4> x{};
    for (u32 bit = 0; index != 0; index >>= 1, ++bit)
        if (index & 1u)
            for (u32 d = 0; d < 4; ++d) x[d] ^= kDirections[d][bit];
    return x;
}

/// The points that every ray loop begins with.
constexpr u32 kTableSize = 1024;
const std::array<std::array<u32, 4>, kTableSize> kTable = [] {
    std::array<std::array<u32, 4>, kTableSize> table{};
    for (u32 i = 0; i < kTableSize; ++i) table[i] = makePoint(i);
    return table;
}();

} // namespace

std::array<u32, 4> sobol4(u32 index)
{
    return index < kTableSize ? kTable[index] : makePoint(index);
}

std::array<double, 4> shiftedSobol4(u32 index, const std::array<u32, 4>& shift)
{
    const std::array<u32, 4> x = sobol4(index);
    std::array<double, 4> out;
    for (u32 d = 0; d < 4; ++d) out[d] = double(x[d] ^ shift[d]) * 0x1.0p-32;
    return out;
}

std::array<u32, 4> digitalShift(u64 seed)
{
    Random random(seed);
    std::array<u32, 4> shift;
    for (u32& s : shift) s = u32(random.next() >> 32);
    return shift;
}

} // namespace helio
