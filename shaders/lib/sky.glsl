// SPDX-License-Identifier: Apache-2.0
// The picture's sky: a gradient from the horizon to the zenith with a glow around the sun. Display only: the light solve
// knows the uniform sky. Needs `view`, a ViewRecord.
vec3 skyRadiance(vec3 direction)
{
    const float up = max(direction.z, 0.0);
    vec3 radiance = mix(view.zenith.rgb, view.horizon.rgb, pow(1.0 - up, view.zenith.w));
    const float toSun = max(dot(direction, view.sunDirection.xyz), 0.0);
    radiance += view.glow.rgb * (pow(toSun, 8.0) * 0.25 + pow(toSun, 64.0) * 0.5) * view.sunDirection.w;
    // Below the horizon, where the ground of the scene ends, the haze of the horizon darkens slowly.
    return direction.z < 0.0 ? radiance * mix(1.0, view.horizon.w, min(1.0, -4.0 * direction.z)) : radiance;
}
