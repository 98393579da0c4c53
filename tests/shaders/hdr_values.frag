#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/radiance.glsl"

layout(set = 0, binding = 0) uniform Params {
    // Texels to the right by which the row of values begins later.
    int shift;
    // Whether values are guarded, as every shipped shader guards what it stores.
    bool guarded;
    // Values further to the right for each sample; with one a texel 0.
    int by_sample;
} params;

layout(location = 0) out vec4 color;

// 0, −0, a denormal of 32 bits, a denormal of 16 bits, 1/2, 1, 100, 65504, 65520, 10⁶, 10³⁸, +inf, −inf, NaN, −1, −65520: their
// bits.
const uint VALUES[16] = uint[](
    0u, 0x80000000u, 1u, 0x33800000u, 0x3f000000u, 0x3f800000u, 0x42c80000u, 0x477fe000u, 0x477ff000u, 0x49742400u, 0x7e967699u,
    0x7f800000u, 0xff800000u, 0x7fc00000u, 0xbf800000u, 0xc77ff000u);

// For a target of 16 × 16: each texel of a row another value, and each row begins with the next one.
void main() {
    const ivec2 texel = ivec2(gl_FragCoord.xy);
    const int number = params.by_sample == 0 ? 0 : gl_SampleID * params.by_sample;
    const float value = uintBitsToFloat(VALUES[(texel.x + texel.y * params.shift + number) & 15]);
    color = vec4(vec3(params.guarded ? guard_radiance(value) : value), 1.0);
}
