#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/scene.glsl"

layout(location = 0) out vec3 direction;

// One triangle that covers every pixel, infinitely far away: reversed depth 0.
void main() {
    const vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0;
    const vec4 clip = vec4(corner, 0.0, 1.0);
    // Points of the far plane have no position (w is 0), only a direction.
    direction = (view.clip_to_world * clip).xyz;
    gl_Position = rotate_clip(clip);
}
