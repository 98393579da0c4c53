#version 460
#extension GL_GOOGLE_include_directive : require
#include "include/scene.glsl"
layout(local_size_x = 1) in;
layout(constant_id = 0) const uint ACROSS = 1u;
layout(constant_id = 1) const uint DOWN = 1u;
layout(set = 0, binding = 0, std430) writeonly buffer Bounds { vec4 box[]; } bounds;
void main() {
    const uint at = gl_GlobalInvocationID.x + ACROSS * (gl_GlobalInvocationID.y + DOWN * gl_GlobalInvocationID.z);
    const vec2 low = vec2(gl_GlobalInvocationID.xy) / vec2(ACROSS, DOWN) * 2.0 - 1.0;
    const vec4 near = view.clip_to_world * vec4(low, 0.5, 1.0);
    bounds.box[2u * at] = near; bounds.box[2u * at + 1u] = near + 1.0;
}
