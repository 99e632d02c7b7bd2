// SPDX-License-Identifier: Apache-2.0
// The picture's sky: a gradient from the horizon to the zenith with a glow around the sun (PictureSky), and a plain below. A
// linear picture has the uniform sky, and below the horizon the ground beyond the scene if the light solve knows one.
// Needs `view`, a ViewRecord.
vec3 domeRadiance(vec3 direction)
{
    // Products, since a power costs a software device tens of them.
    const float low = 1.0 - clamp(direction.z, 0.0, 1.0); // a normalised z may be 1 + an ulp
    const float toSun = max(dot(direction, view.sunDirection.xyz), 0.0);
    const float c2 = toSun * toSun, c4 = c2 * c2, c8 = c4 * c4, c16 = c8 * c8, c32 = c16 * c16;
    return mix(view.zenith.rgb, view.horizon.rgb, low * low * low) + view.glow.rgb * (0.25 * c8 + 0.5 * c32 * c32);
}

vec3 backgroundRadiance(vec3 direction)
{
    const vec3 radiance = domeRadiance(direction);
    if (direction.z >= 0.0) return radiance;
    // Where the ground of the scene ends, a plain goes on and fades into the horizon.
    return mix(radiance, view.ground.rgb, exp(view.horizon.w * view.ground.w / direction.z));
}
