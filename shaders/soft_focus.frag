#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"

// What is in focus.
layout(set = 0, binding = 0) uniform sampler2D sharp;
// The same, blurred; of any size.
layout(set = 0, binding = 1) uniform sampler2D soft;
layout(set = 0, binding = 2) uniform Params {
    // 0 shows the sharp image alone, 1 the soft one.
    float strength;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Mixes two images, as a lens does that draws softly.
void main() {
    const vec4 focused = guard_color(found_in(sharp, sharp_st, uv));
    const vec4 blurred = guard_color(found_in(soft, soft_st, uv));
    color = guard_color(mix(focused, blurred, clamp(params.strength, 0.0, 1.0)));
}
