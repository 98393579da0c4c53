#version 460
#extension GL_GOOGLE_include_directive : require

#include "towards.glsl"

layout(local_size_x = 8, local_size_y = 8) in;

layout(set = 0, binding = 0, rgba32f) uniform writeonly image2D target;

void main() {
    const ivec2 texel = ivec2(gl_GlobalInvocationID.xy);
    const ivec2 size = imageSize(target);
    if (all(lessThan(texel, size))) {
        imageStore(target, texel, towards((vec2(texel) + 0.5) / vec2(size)));
    }
}
