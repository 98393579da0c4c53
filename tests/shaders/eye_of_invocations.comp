#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/stereo.glsl"
#include "include/texture.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, rgba32f) uniform writeonly image2D target;

// Which eye it runs for, and what that one sees.
void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(texel, imageSize(target)))) {
        imageStore(target, texel, vec4(eye_index, texel_in(source, source_st, texel).rgb));
    }
}
