// SPDX-License-Identifier: Apache-2.0
#pragma once
#include "tools/bench/case_list.h"

namespace helio {

/// Stage 3's kernel on made-up rows: 250,000 x 64 and 1,000,000 x 16 links of constant senders, 1,000,000 x 24 of
/// linear ones, nine senders of ten within 2,000 nodes of the receiver and the others within 32,000; against the same
/// links as plain storage buffers and as loops of two threads of the host over the packed links. Rooflines: stream
/// copy, and random loads from tables of 64 KiB to 64 MiB.
void addGatherCases(CaseList& cases);

} // namespace helio
