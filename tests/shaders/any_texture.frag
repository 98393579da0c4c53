#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/texture.glsl"

layout(set = 0, binding = 0) uniform TEXTURE_source source;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The sum of all samples in all layers, found by texel and by place in turn; in alpha how many there are.
void main() {
    const ivec2 texel = texel_at(uv, extent_of(source));
    vec3 sum = vec3(0.0);
    for (int layer = 0; layer < layers_of(source); ++layer) {
        for (int number = 0; number < samples_of(source); ++number) {
            const vec4 found = (texel.x + number) % 2 == 0 ? texel_of(source, texel, layer, number)
                                                           : found_at(source, uv, layer, number);
            sum += found.rgb;
        }
    }
    color = vec4(sum, float(100 * layers_of(source) + samples_of(source)));
}
