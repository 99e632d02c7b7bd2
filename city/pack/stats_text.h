// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <string>

#include "city/pack/pipeline.h"

namespace helio {

/// Most memory that this process has held, MiB.
double peakMemoryMiB();

/// What the links of a pack take, bytes a link, in words.
std::string linkBytesText(const LinkBytes& bytes, u64 linkCount);

/// The statistics of a bake for people: a few aligned lines.
std::string statsText(const BakeStats& stats, double peakMiB);

/// The same for programs: one JSON object, numbers in the units that the keys name.
std::string statsJson(const BakeStats& stats, double peakMiB);

} // namespace helio
