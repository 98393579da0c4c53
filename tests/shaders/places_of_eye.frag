#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/stereo.glsl"

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 scale_and_offset;
layout(location = 1) out vec4 there_and_back;
layout(location = 2) out vec4 two;
layout(location = 3) out vec4 undivided;

// What the helpers make of a place in an eye's picture.
void main() {
    const vec2 place = screen_uv(uv);
    const float w = 1.0 + 3.0 * uv.y;
    const vec4 clip = vec4((2.0 * uv - 1.0) * w, 0.5, w);
    scale_and_offset = scale_offset;
    there_and_back = vec4(place, uv_unadjust(place, scale_offset));
    two = screen_uv(vec4(uv, 1.0 - uv));
    const vec3 own = non_stereo_screen_pos(clip);
    const vec3 packed = screen_pos(clip);
    undivided = vec4(own.xy / own.z, packed.xy / packed.z);
}
