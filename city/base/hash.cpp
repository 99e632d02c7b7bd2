// SPDX-License-Identifier: Apache-2.0
#include "city/base/hash.h"

#include <xxhash.h>

namespace helio {

u64 hashBytes(std::span<const std::byte> bytes, u64 seed)
{
    return XXH3_64bits_withSeed(bytes.data(), bytes.size(), seed);
}

u64 hashText(std::string_view text, u64 seed)
{
    return XXH3_64bits_withSeed(text.data(), text.size(), seed);
}

u64 mixSeed(u64 seed, u64 value)
{
    const u64 both[2] = {seed, value};
    return XXH3_64bits(both, sizeof both);
}

// SplitMix64: Steele, Lea, Flood, "Fast splittable pseudorandom number generators", OOPSLA 2014.
u64 Random::next()
{
    state_ += 0x9E3779B97F4A7C15ull;
    u64 z = state_;
    z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
    z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
    return z ^ (z >> 31);
}

} // namespace helio
