#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "towards.glsl"

layout(location = 0) out vec3 ray;
layout(location = 1) flat out float eye;

// A triangle in the world that covers all that the eye sees.
void main() {
    const vec2 corner = vec2(gl_VertexIndex % 3 == 1 ? 3.0 : -1.0, gl_VertexIndex % 3 == 2 ? 3.0 : -1.0);
    const vec4 there = view.clip_to_world * vec4(corner, 0.5, 1.0);
    const vec3 place = there.xyz / there.w;
    gl_Position = rotate_clip(view.world_to_clip * vec4(place, 1.0));
    ray = place - view.eye_position;
    eye = towards(vec2(0.5)).w;
}
