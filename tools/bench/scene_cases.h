// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "engine/view/renderer.h"
#include "tools/bench/case_list.h"

namespace helio {

/// Bytes that a sweep must move if every array passes the memory once: links, rows and senders read and E written by
/// the gather, the new B of the patches written, B pulled up.
double bytesOfSweep(const TileTables& tile);

/// A pack's whole solve and frame: a cold and a warm sun change with their split, one sweep, a camera move.
void addSceneCases(CaseList& cases, const Pack& pack, Renderer& renderer, const Camera& camera);

} // namespace helio
