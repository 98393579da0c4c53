#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/grading.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// What is shown, 0 to 1, in linear values: after tone mapping.
layout(set = 0, binding = 0) uniform sampler2D source;
// The table: squares side by side, as many as each is wide and high. Red grows to the right within a square, green down, and blue
// from square to square. Entries are colours as a display encodes them, so a picture has `color_space: Linear`.
layout(set = 0, binding = 1) uniform sampler2D table;
layout(set = 0, binding = 2) uniform Params {
    // How much of the graded colour is mixed in: 0 is none, 1 all.
    float strength;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The entry of the table at a red, green and blue.
vec3 entry(ivec3 at) {
    const ivec2 extent = used_of(table, table_st);
    return min(guard_radiance(texel_in(table, table_st, min(ivec2(at.z * extent.y + at.x, at.y), extent - 1)).rgb), 1.0);
}

// Each colour becomes what the table says of it: between entries, the mean of the eight around it by their distances.
void main() {
    const vec3 shown = min(guard_radiance(found_in(source, source_st, uv).rgb), 1.0);
    const int last = used_of(table, table_st).y - 1;
    const vec3 place = encode_srgb(shown) * float(last);
    const ivec3 from = clamp(ivec3(place), ivec3(0), ivec3(max(last - 1, 0)));
    const ivec3 to = min(from + 1, last);
    const vec3 share = place - vec3(from);
    const vec3 near = mix(mix(entry(from), entry(ivec3(to.r, from.gb)), share.r),
                          mix(entry(ivec3(from.r, to.g, from.b)), entry(ivec3(to.rg, from.b)), share.r), share.g);
    const vec3 far = mix(mix(entry(ivec3(from.rg, to.b)), entry(ivec3(to.r, from.g, to.b)), share.r),
                         mix(entry(ivec3(from.r, to.gb)), entry(to), share.r), share.g);
    const vec3 graded = decode_srgb(mix(near, far, share.b));
    color = vec4(guard_radiance(mix(shown, graded, clamp(params.strength, 0.0, 1.0))), 1.0);
}
