// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/pack/pipeline.h"

namespace helio {

/// Most memory that this process has held, MiB.
double peakMemoryMiB();

/// The statistics of a bake for people: a few aligned lines.
std::string statsText(const BakeStats& stats, double peakMiB);

/// The same for programs: one JSON object, numbers in the units that the keys name.
std::string statsJson(const BakeStats& stats, double peakMiB);

} // namespace helio
