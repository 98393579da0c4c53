#version 460

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// For a target of 256 × 256: in red every half float by its bits, infinities and NaN included; in green as many 32-bit
// floats of every exponent, also beyond what a half holds; in blue 0…128 in equal steps.
void main() {
    const uvec2 pixel = uvec2(uv * 256.0);
    const uint bits = pixel.y * 256u + pixel.x;
    color = vec4(unpackHalf2x16(bits).x, uintBitsToFloat(bits << 16), float(bits) / 512.0, 1.0);
}
