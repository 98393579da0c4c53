#version 460

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Numbers that go wrong easily and others, their bits: 0, −0, a denormal, 1/2, 1, 100, 65504, 10³⁰, the largest, +inf, −inf, NaN,
// NaN with a sign, −1, −10³⁰, a negative denormal.
const uint VALUES[16] = uint[](
    0u, 0x80000000u, 1u, 0x3f000000u, 0x3f800000u, 0x42c80000u, 0x477fe000u, 0x7149f2cau, 0x7f7fffffu, 0x7f800000u, 0xff800000u,
    0x7fc00000u, 0xffc00000u, 0xbf800000u, 0xf149f2cau, 0x80000001u);

// For a target of 32 × 16: in the left half another number in each channel of each texel, in the right one squares of 4 × 4 texels
// that hold one number in all channels.
void main() {
    const uvec2 texel = uvec2(uv * vec2(32.0, 16.0));
    uvec4 value = uvec4((texel.y / 4u) * 4u + (texel.x - 16u) / 4u);
    if (texel.x < 16u) {
        value = (uvec4(1u, 3u, 5u, 7u) * texel.x + uvec4(1u, 2u, 3u, 5u) * texel.y) % 16u;
    }
    color = vec4(uintBitsToFloat(VALUES[value.r]), uintBitsToFloat(VALUES[value.g]), uintBitsToFloat(VALUES[value.b]),
                 uintBitsToFloat(VALUES[value.a]));
}
