#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"
#include "include/texture.glsl"

// What this frame shows.
layout(set = 0, binding = 0) uniform sampler2D now;
// This shader's previous output; all zero before the first.
layout(set = 0, binding = 1) uniform sampler2D before;
layout(set = 0, binding = 2) uniform Params {
    // How many frames are averaged, 1 or more. The mean of so many stays.
    int frames;
} params;

layout(location = 0) in vec2 uv;

// The mean, and in alpha the number of frames that it is of: for a target of 32 bits a channel.
layout(location = 0) out vec4 color;

// The mean of frames, each of which counts alike.
void main() {
    const vec3 drawn = guard_radiance(found_in(now, now_st, uv).rgb);
    const vec4 kept = found_in(before, before_st, uv);
    const vec3 mean = guard_radiance(kept.rgb);
    const float number = guard_radiance(kept.a);
    const bool goes_on = number < float(params.frames);
    color = vec4(goes_on ? mean + (drawn - mean) / (number + 1.0) : mean, goes_on ? number + 1.0 : number);
}
