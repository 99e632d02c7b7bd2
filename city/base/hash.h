// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <span>
#include <string_view>

#include "city/base/types.h"

namespace helio {

/// XXH3 64-bit hash of bytes; the same on every machine. Used for checksums and for seeds.
u64 hashBytes(std::span<const std::byte> bytes, u64 seed = 0);
u64 hashText(std::string_view text, u64 seed = 0);
/// Mixes a value into a seed (order matters): hash(building, key, rule) = mix(mix(building, key), rule).
u64 mixSeed(u64 seed, u64 value);

/// A small counter-based random stream (SplitMix64): value k depends on the seed and k alone.
class Random
{
public:
    explicit Random(u64 seed) : state_(seed) {}
    u64 next();
    /// Uniform in [0, 1).
    double uniform() { return double(next() >> 11) * 0x1.0p-53; }

private:
    u64 state_;
};

} // namespace helio
