#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

// What this shader drew one and two frames before.
layout(set = 0, binding = 0) uniform usampler2D before;
layout(set = 0, binding = 1) uniform usampler2D older;
layout(set = 0, binding = 2) uniform Params {
    ivec2 extent;
} params;

layout(location = 0) out uint number;

// The texel of an earlier picture that lies where this fragment lies.
ivec2 there(ivec2 here, ivec2 extent) {
    return here * extent / params.extent;
}

// The number of the fragment, a half of what was there before, and a quarter of what was there in the frame before that.
void main() {
    const ivec2 here = ivec2(gl_FragCoord.xy);
    const uint last = texel_in(before, before_st, there(here, used_of(before, before_st))).r;
    const uint first = texel_in(older, older_st, there(here, used_of(older, older_st))).r;
    number = uint(1000 + here.x + 100 * here.y) + last / 2u + first / 4u;
}
