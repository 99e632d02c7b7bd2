// SPDX-License-Identifier: Apache-2.0
// The sun's disc where it matters: cut by the horizon, and on planes that it grazes. t = height of the disc's centre above a
// line, in radii. A disc of uniform radiance, its limb as sharp as it looks: refraction flattens and the air darkens it near
// the horizon by more than what that changes.
#ifndef HELIO_DISC_H
#define HELIO_DISC_H
#include "interop.h"

#ifdef __cplusplus
#include <algorithm>
#include <cmath>
#define HELIO_FUNCTION inline
#else
#define HELIO_FUNCTION
#endif

HELIO_SHARED_BEGIN

#ifdef __cplusplus
using std::asin;
using std::max;
using std::min;
using std::sqrt;
#endif

HELIO_CONSTANT float kSunRadius = 0.0046542f; // rad: 0.26667 degrees (NREL/TP-560-34302)
HELIO_CONSTANT float kInversePi = 0.31830988618f;

// Share of the disc that stands above the line.
HELIO_FUNCTION float discShare(float t)
{
    const float x = max(-1.0f, min(t, 1.0f));
    return 0.5f + kInversePi * (asin(x) + x * sqrt(1.0f - x * x));
}

// Mean over the whole disc of the height above the line of what stands above it, in radii.
HELIO_FUNCTION float discHeight(float t)
{
    const float x = max(-1.0f, min(t, 1.0f));
    const float s = max(0.0f, 1.0f - x * x);
    return t * discShare(t) + 0.6666667f * kInversePi * s * sqrt(s);
}

// Irradiance of a plane over that of one that faces the sun, from the cosine between its normal and the direction of the
// disc's centre; radius 0 is a sun that is a point. On edge 2 / (3 pi) radius.
HELIO_FUNCTION float discCosine(float cosine, float radius)
{
    if (cosine >= radius) return cosine;
    return cosine > -radius ? radius * discHeight(cosine / radius) : 0.0f;
}

HELIO_SHARED_END
#endif
