#version 460

layout(location = 0) out vec4 color;

// Bytes of the texel's number in rows of 8: all four differ, and so do those of neighbours.
void main() {
    const uint texel = uint(gl_FragCoord.x) + 8u * uint(gl_FragCoord.y);
    color = vec4((37u * texel + uvec4(0u, 71u, 142u, 213u)) & 255u) / 255.0;
}
