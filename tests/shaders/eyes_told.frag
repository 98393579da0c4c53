#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/stereo.glsl"

layout(location = 0) in vec2 uv;
layout(location = 1) flat in ivec2 told;

layout(location = 0) out vec4 eyes;
layout(location = 1) out vec4 places;
layout(location = 2) out vec4 undivided;

// Which eye and instance the stages are told, and what the helpers make of a place in the eye's picture.
void main() {
    const vec4 clip = vec4((2.0 * uv - 1.0) * (1.0 + uv.y), 0.5, 1.0 + uv.y);
    eyes = vec4(told, eye_index, 0.25);
    places = vec4(screen_uv(uv), frag_coord().xy);
    undivided = vec4(screen_pos(clip).xy, non_stereo_screen_pos(clip).xy) + scale_offset;
}
