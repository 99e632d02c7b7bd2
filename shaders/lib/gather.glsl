// SPDX-License-Identifier: Apache-2.0
// Stage 3: the light that arrives at each node over its own links, E_i = sum F_ij B_j. One thread a receiver, links in their
// order and no atomics, so the same input gives the same bits. The includer defines fetchLinks(record),
// fetchRadiosity(node) and, for HELIO_LINEAR, fetchSlope(index). Patches have no slopes, so that links to them need no
// moments: with linear senders a row is pairs of links to patches, then single links to inner nodes.
layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kGatherRows, scalar) readonly buffer Rows { uint rows[]; };
layout(set = 0, binding = kGatherOrder, scalar) readonly buffer Order { uint receivers[]; };
layout(set = 0, binding = kGatherIrradiance, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
layout(push_constant, scalar) uniform Params { GatherParams params; };

void main()
{
    const uint k = globalIndex(kSolveGroup);
    if (k >= params.rowCount) return;
    const uint row = params.rowFirst + k;
#ifdef HELIO_LINEAR
    const uint begin = rows[2u * row] - params.recordFirst, end = rows[2u * row + 1u] - params.recordFirst;
#else
    const uint begin = rows[row] - params.recordFirst, end = rows[row + 1u] - params.recordFirst;
#endif
    vec4 sum = vec4(0.0);
    for (uint pair = begin; pair < end; ++pair) {
        const uvec4 links = fetchLinks(pair);
        sum += uintBitsToFloat(links.y) * fetchRadiosity(links.x);
        sum += uintBitsToFloat(links.w) * fetchRadiosity(links.z);
    }
#ifdef HELIO_LINEAR
    const uint last = rows[2u * row + 2u] - params.recordFirst;
    for (uint record = end; record < last; ++record) {
        const uvec4 link = fetchLinks(record);
        const uint slope = 2u * (link.x - params.patchCount);
        sum += uintBitsToFloat(link.y) * fetchRadiosity(link.x);
        sum += uintBitsToFloat(link.z) * fetchSlope(slope);
        sum += uintBitsToFloat(link.w) * fetchSlope(slope + 1u);
    }
#endif
    irradiance[receivers[row]] = sum;
}
