// SPDX-License-Identifier: Apache-2.0
// A uniform block: software devices read a word of it once, and a word of a storage buffer lane by lane.
layout(set = 0, binding = kForwardView, scalar) uniform View { ViewRecord view; };
