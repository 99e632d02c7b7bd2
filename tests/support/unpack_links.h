// SPDX-License-Identifier: Apache-2.0
// The links that a device reads in packed form, taken apart again in plain C++.
#pragma once
#include <vector>

#include "engine/stream/link_packing.h"

namespace helio::twin {

/// Rows of links as in the pack, a receiver each, in double; parallel to the receivers' numbers.
struct UnpackedLink
{
    u32 column = 0;
    double factor = 0.0, momentX = 0.0, momentY = 0.0;
    bool single = false;
};
std::vector<std::vector<UnpackedLink>> unpackLinks(const PackedLinks& packed, u32 receiverCount, u32 patchCount);

} // namespace helio::twin
