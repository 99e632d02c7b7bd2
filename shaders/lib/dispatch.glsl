// SPDX-License-Identifier: Apache-2.0
// Index of this invocation in a dispatch that may fold long counts into a second dimension (65 535 groups a dimension).
// The group size is given: gl_WorkGroupSize is not what it seems before the layout that declares it.
uint globalIndex(uint groupSize)
{
    return (gl_WorkGroupID.y * gl_NumWorkGroups.x + gl_WorkGroupID.x) * groupSize + gl_LocalInvocationID.x;
}
