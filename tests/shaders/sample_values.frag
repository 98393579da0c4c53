#version 460

layout(set = 0, binding = 0) uniform Params {
    uint layer;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// For a target of 32 × 24, a number of its own, exact in 24 bits, for each sample of each texel of each layer.
void main() {
    const uvec2 texel = uvec2(uv * vec2(32.0, 24.0));
    const uint number = ((params.layer * 8u + uint(gl_SampleID)) * 24u + texel.y) * 32u + texel.x;
    color = vec4(float(number), float(number * number % 65521u), float(number % 7u), 1.0);
}
