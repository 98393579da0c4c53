#version 460
#extension GL_GOOGLE_include_directive : require
#include "include/texture.glsl"
#include "include/levels.glsl"
#include "include/scene.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D normal;
layout(set = 0, binding = 2) uniform sampler2D hzb;
layout(set = 0, binding = 3, rgba16f) writeonly uniform image2D hits;
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, part_extent(imageSize(hits), hits_st)))) { return; }
    const vec2 uv = (vec2(at) + 0.5) / vec2(part_extent(imageSize(hits), hits_st));
    const float d = found_in(depth, depth_st, uv).r;
    const vec2 n = found_in(normal, normal_st, uv).rg;
    const vec4 world = view.clip_to_world * vec4(uv * 2.0 - 1.0, d, 1.0);
    const float blocker = found_in_level(hzb, hzb_st, uv + 0.05 * n, 0, 2).r;
    imageStore(hits, at, vec4(uv + 0.05 * n, blocker, d > 0.0 ? world.w * 1e-6 + 0.2 : 0.0));
}
