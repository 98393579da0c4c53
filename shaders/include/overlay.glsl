// How depth and values of either sign are shown. CPU twin: passes/src/twin/overlay.rs.
#ifndef FRAMEWRIGHT_OVERLAY
#define FRAMEWRIGHT_OVERLAY

#include "include/radiance.glsl"

// Distance along the camera's axis as a share of `farthest`, at most 1, from distance.glsl's infinite_depth(): near /
// distance. Depth 0 is infinitely far.
float shade_of_distance(float depth, float near, float farthest) {
    return depth * farthest > near ? near / (depth * farthest) : 1.0;
}

// How values of either sign are shown: 0 as 0.5, -1 as 0 and 1 as 1, times `gain`; what is no number as 0.5.
vec3 shade_of_signed(vec3 value, float gain) {
    return clamp(0.5 * guard_signed(guard_signed(value) * gain) + 0.5, 0.0, 1.0);
}

#endif
