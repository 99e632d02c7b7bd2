// SPDX-License-Identifier: Apache-2.0
// Needs `view`, a ViewRecord.
// m, of the point in hand from the eye.
float distanceOf()
{
    const vec2 ray = view.rayStep * (gl_FragCoord.xy - view.rayCentre);
    return sqrt(1.0 + dot(ray, ray)) / gl_FragCoord.w;
}
