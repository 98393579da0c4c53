#version 460

layout(location = 0) out vec4 color;

// The number of the texel in a picture of 16 columns.
void main() {
    const ivec2 texel = ivec2(gl_FragCoord.xy);
    color = vec4(texel.x + 16 * texel.y, 0.0, 0.0, 1.0);
}
