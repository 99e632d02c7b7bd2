// SPDX-License-Identifier: Apache-2.0
layout(set = 0, binding = kForwardView, scalar) readonly buffer View { ViewRecord view; };
