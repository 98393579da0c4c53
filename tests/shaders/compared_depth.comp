#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/part.glsl"
#include "depths.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2DShadow depth;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D target;
layout(set = 0, binding = 2) uniform Params { float off; } params;

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    const vec2 uv = (vec2(texel) + 0.5) / vec2(imageSize(target));
    const vec2 place = uv_adjust(uv, depth_st) + params.off / vec2(textureSize(depth, 0));
    if (all(lessThan(texel, imageSize(target)))) {
        imageStore(target, texel, vec4(textureLod(depth, vec3(place, depth_at(uv)), 0.0)));
    }
}
