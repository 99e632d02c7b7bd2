// SPDX-License-Identifier: Apache-2.0
#pragma once
#include <map>
#include <string>
#include <vector>

#include "city/model/build_nodes.h"

namespace helio {

/// What holds for every light hierarchy, checked on one. Each count but `covered` ought to be 0.
struct TreeAudit
{
    u64 notFinite = 0;    ///< nodes with an area, centroid, normal or outline that is not a finite number
    u64 noArea = 0;       ///< nodes with zero or negative area
    u64 badNormal = 0;    ///< planar nodes whose normal is not of length 1
    u64 badOutline = 0;   ///< patches whose outline's area differs from their own by more than 1e-5
    u64 badSum = 0;       ///< nodes whose area differs from their children's by more than 1e-9
    u64 badLink = 0;      ///< nodes that come after their parent, or that are not its children
    u64 mixedCovered = 0; ///< planar nodes with covered and free patches
    u64 facesInwards = 0; ///< patches that look into their own building and are not covered
    std::map<std::string, u64> inwardsByName; ///< of these, by the name of their rule
    double areaLedger = 0;                    ///< |sum of the patches' areas / that of the derivation's polygons - 1|
    double rhoLedger = 0;              ///< the same for reflectance x area, against the pieces; the largest channel
    std::vector<std::string> examples; ///< the first few faults, one line each

    bool good() const;
};

/// `inwards`: also looks for patches that face into their own building: of 24 rays from the half space before a patch,
/// tested against the building's own patches alone, more than half meet the back of one first. Rays of walls and slopes
/// run nearly level, for a wall under an eave sees the back of the roof.
TreeAudit auditTree(const NodeTreeBuild& build, const ShapeTree& shapes, bool inwards, u32 jobs);

/// Memory of what buildNodes gives back, bytes.
u64 bytesOf(const NodeTreeBuild& build);

} // namespace helio
