#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

// The level above.
layout(set = 0, binding = 0) uniform sampler2D above;

layout(location = 0) out vec4 color;

// The mean of the four texels above.
void main() {
    const ivec2 last = used_of(above, above_st) - 1;
    const ivec2 first = 2 * ivec2(gl_FragCoord.xy);
    vec4 sum = vec4(0.0);
    for (int i = 0; i < 4; ++i) {
        sum += texel_in(above, above_st, min(first + ivec2(i & 1, i >> 1), last));
    }
    color = 0.25 * sum;
}
