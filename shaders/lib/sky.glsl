// SPDX-License-Identifier: Apache-2.0
// The picture's background: a gradient from the horizon to the zenith with a glow around the sun, and a plain below. Display
// only: a linear picture has the uniform sky, and below the horizon the ground beyond the scene if the light solve knows one.
// Needs `view`, a ViewRecord.
vec3 skyRadiance(vec3 direction)
{
    const float up = clamp(direction.z, 0.0, 1.0); // a normalised z may be 1 + an ulp
    vec3 radiance = mix(view.zenith.rgb, view.horizon.rgb, pow(1.0 - up, view.zenith.w));
    const float toSun = max(dot(direction, view.sunDirection.xyz), 0.0);
    radiance += view.glow.rgb * (pow(toSun, 8.0) * 0.25 + pow(toSun, 64.0) * 0.5) * view.sunDirection.w;
    if (direction.z >= 0.0) return radiance;
    // Where the ground of the scene ends, a plain goes on and fades into the horizon.
    return mix(radiance, view.ground.rgb, exp(view.horizon.w * view.ground.w / direction.z));
}
