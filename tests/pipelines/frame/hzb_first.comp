#version 460
#extension GL_GOOGLE_include_directive : require
#include "include/part.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, r32f) writeonly uniform image2D target;
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, part_extent(imageSize(target), target_st)))) { return; }
    const ivec2 last = part_extent(textureSize(source, 0), source_st) - 1;
    float farthest = 1.0;
    for (int i = 0; i < 9; ++i) { farthest = min(farthest, texelFetch(source, min(at * 2 + ivec2(i % 3, i / 3), last), 0).r); }
    imageStore(target, at, vec4(farthest));
}
