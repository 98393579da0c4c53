#version 460

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// A number without pattern, 0…1, for a texel (an integer hash by its bits, "lowbias32" of C. Wellons).
float noise(uvec2 texel, uint channel) {
    uint bits = texel.x + 4096u * texel.y + 1048576u * channel;
    bits = (bits ^ (bits >> 16)) * 0x7feb352du;
    bits = (bits ^ (bits >> 15)) * 0x846ca68bu;
    return float(bits >> 8) / 16777216.0;
}

// For a target of 64 × 48: dim in red, very bright in green, mostly black with bright texels in blue.
void main() {
    const uvec2 texel = uvec2(uv * vec2(64.0, 48.0));
    const float spark = noise(texel, 2u);
    color = vec4(noise(texel, 0u), 60000.0 * noise(texel, 1u), spark > 0.95 ? 1000.0 * spark : 0.0, noise(texel, 3u));
}
