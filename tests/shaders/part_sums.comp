#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/part.glsl"

layout(local_size_x = 8, local_size_y = 4) in;

layout(set = 0, binding = 0, r32ui) uniform readonly uimage2D from;
layout(set = 0, binding = 1, r32ui) uniform writeonly uimage2D to;

// The sum of the nine texels around each, of which the outermost are repeated.
void main() {
    const ivec2 here = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 last = part_extent(imageSize(from), from_st) - 1;
    uint sum = 0u;
    for (int i = 0; i < 9; ++i) {
        sum += imageLoad(from, clamp(here + ivec2(i % 3, i / 3) - 1, ivec2(0), last)).r;
    }
    imageStore(to, here, uvec4(sum));
}
