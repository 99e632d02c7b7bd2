// SPDX-License-Identifier: Apache-2.0
// Stage 3: the light that arrives at each node over its own links, E_i = sum F_ij B_j. One thread a receiver, links in their
// order and no atomics, so the same input gives the same bits. The includer defines fetchLinks(pair) and fetchRadiosity(node).
layout(local_size_x = kSolveGroup) in;
layout(set = 0, binding = kGatherRows, scalar) readonly buffer Rows { uint rows[]; };
layout(set = 0, binding = kGatherIrradiance, scalar) writeonly buffer Irradiance { vec4 irradiance[]; };
layout(push_constant, scalar) uniform Params { GatherParams params; };

void main()
{
    const uint k = globalIndex(kSolveGroup);
    if (k >= params.rowCount) return;
    const uint row = params.rowFirst + k;
    const uint end = rows[row + 1u] - params.pairFirst;
    vec4 sum = vec4(0.0);
    for (uint pair = rows[row] - params.pairFirst; pair < end; ++pair) {
        const uvec4 links = fetchLinks(pair);
        sum += uintBitsToFloat(links.y) * fetchRadiosity(links.x);
        sum += uintBitsToFloat(links.w) * fetchRadiosity(links.z);
    }
    irradiance[row] = sum;
}
