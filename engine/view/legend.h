// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/base/types.h"
#include "engine/view/renderer.h"

namespace helio {

/// Draws the false colours of a picture with the values of their ends into its upper left corner: 0 and `largest` with
/// a unit (digits, letters, '/', '.', '-' and spaces). Nothing in pictures too small for it.
void drawLegend(Picture& picture, double largest, const std::string& unit);

} // namespace helio
