#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/scene.glsl"

layout(location = 0) out vec3 direction;

// One triangle that covers every pixel, on the far plane or infinitely far away: reversed depth 0.
void main() {
    const vec2 corner = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2) * 2.0 - 1.0;
    const vec4 clip = vec4(corner, 0.0, 1.0);
    // Without a far plane these points have no position (w is 0), only a direction.
    const vec4 far = view.clip_to_world * clip;
    direction = far.xyz - far.w * view.eye_position;
    gl_Position = rotate_clip(clip);
}
