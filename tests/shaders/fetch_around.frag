#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/texture.glsl"

layout(set = 0, binding = 0) uniform TEXTURE_source source;

layout(location = 0) out vec4 color;

// Samples of whole numbers around the fragment, each times another one: exact.
void main() {
    const ivec2 last = used_of(source, source_st) - 1;
    vec4 sum = vec4(0.0);
    for (int at = 0; at < 9; ++at) {
        const ivec2 texel = clamp(ivec2(frag_coord().xy) + 3 * ivec2(at % 3 - 1, at / 3 - 1), ivec2(0), last);
        for (int number = 0; number < samples_of(source); ++number) {
            sum += float(at + 1) * float(number + 1) * texel_in(source, source_st, texel, 0, number);
        }
    }
    color = sum;
}
