#version 460
#extension GL_GOOGLE_include_directive : require
#include "include/texture.glsl"
#include "include/scene.glsl"
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D depth;
layout(set = 0, binding = 1) uniform sampler2D normal;
layout(set = 0, binding = 2) uniform sampler2D hzb;
layout(set = 0, binding = 3, rgba16f) writeonly uniform image2D hits;
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(hits)))) { return; }
    const vec2 uv = (vec2(at) + 0.5) / vec2(imageSize(hits));
    const float d = textureLod(depth, uv_adjust(uv, depth_st), 0.0).r;
    const vec2 n = textureLod(normal, uv_adjust(uv, normal_st), 0.0).rg;
    const vec4 world = view.clip_to_world * vec4(uv * 2.0 - 1.0, d, 1.0);
    const float blocker = textureLod(hzb, uv_adjust(uv + 0.05 * n, hzb_st), 2.0).r;
    imageStore(hits, at, vec4(uv + 0.05 * n, blocker, d > 0.0 ? world.w * 1e-6 + 0.2 : 0.0));
}
