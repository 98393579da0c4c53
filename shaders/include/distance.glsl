// Distance from the depth that a camera's picture has, with a far plane or without. CPU twin: passes/src/twin/distance.rs.
#ifndef FRAMEWRIGHT_DISTANCE
#define FRAMEWRIGHT_DISTANCE

#include "include/scene.glsl"

// The two numbers of the projection: depth is y / distance - x. Without a far plane x is 0 and y the near distance.
vec2 depth_terms() {
    const mat4 rows = transpose(view.world_to_clip);
    // An eye stands beside the camera, so both rows have a last number.
    const float slope = -dot(rows[2].xyz, rows[3].xyz) / dot(rows[3].xyz, rows[3].xyz);
    return vec2(slope, rows[2].w + slope * rows[3].w);
}

// The distance of the near plane, metres along the camera's axis.
float near_distance() {
    const vec2 terms = depth_terms();
    return terms.y / (1.0 + terms.x);
}

// The depth that a camera without a far plane gives the same place, near / distance. Depth 0, where nothing was drawn, stays 0.
float infinite_depth(float depth) {
    const float slope = depth_terms().x;
    return depth > 0.0 ? (depth + slope) / (1.0 + slope) : 0.0;
}

#endif
