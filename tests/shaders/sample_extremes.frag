#version 460

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Numbers that go wrong easily and others, their bits: 0, −0, a denormal, 2⁻¹⁰, 1/2, 1, 12, 100, 1000, 65504, 10³⁰, +inf, −inf,
// NaN, −1, −10³⁰.
const uint VALUES[16] = uint[](
    0u, 0x80000000u, 1u, 0x3a800000u, 0x3f000000u, 0x3f800000u, 0x41400000u, 0x42c80000u, 0x447a0000u, 0x477fe000u, 0x7149f2cau,
    0x7f800000u, 0xff800000u, 0x7fc00000u, 0xbf800000u, 0xf149f2cau);

// For a target of 32 × 24: other numbers in each sample of each texel; in the left half of it none that isn't finite or is
// negative.
void main() {
    const uvec2 texel = uvec2(uv * vec2(32.0, 24.0));
    const uint number = uint(gl_SampleID);
    const uvec3 at = uvec3(texel.x + 5u * number, texel.y + number * texel.x, texel.x * texel.y + 3u * number);
    const uvec3 value = texel.x < 16u ? uvec3(0u, 3u, 3u) + at % uvec3(10u, 7u, 7u) : at % 16u;
    color = vec4(uintBitsToFloat(VALUES[value.r]), uintBitsToFloat(VALUES[value.g]), uintBitsToFloat(VALUES[value.b]), 1.0);
}
