// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "city/model/footprint.h"

namespace helio {

/// Drops every footprint whose polygon equals an earlier one's (corners within 1 cm, in any order of travel); the
/// earlier one takes the larger height. One note each.
void dropEqualFootprints(Layout& layout);

/// Where two footprints overlap by more than 0.5 m2, cuts the common part from the lower one (from the later one if
/// equally high). What remains is cleaned; pieces below 1 m2 vanish. One note each. Needs heights.
void cutOverlaps(Layout& layout);

} // namespace helio
