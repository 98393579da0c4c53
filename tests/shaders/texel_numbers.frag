#version 460

layout(location = 0) out vec4 color;

// Each texel's place, whole numbers.
void main() {
    color = vec4(floor(gl_FragCoord.xy), 0.0, 1.0);
}
