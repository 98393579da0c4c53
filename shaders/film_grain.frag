#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/film_grain.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// Radiance, or what is shown of it in linear values.
layout(set = 0, binding = 0) uniform sampler2D source;
// The number of the frame, as `count_frames` leaves it.
layout(set = 0, binding = 1) uniform Frame {
    uint number;
} frame;
layout(set = 0, binding = 2) uniform Params {
    // By what share a pixel becomes brighter or darker at most, 0 to 1.
    float strength;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The grain of film, another one in each frame: in shares of the light, as grains of silver let it through. Black stays black.
void main() {
    const ivec2 pixel = texel_at(uv, used_of(source, source_st));
    const vec4 found = guard_color(texel_in(source, source_st, pixel));
    const float strength = clamp(params.strength, 0.0, 1.0);
    color = guard_color(vec4(found.rgb * (1.0 + strength * grain(uvec2(pixel), frame.number)), found.a));
}
