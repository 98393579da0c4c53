#version 460

// A triangle that covers the left half: its right edge runs between two columns of texels.
void main() {
    gl_Position = vec4(gl_VertexIndex == 2 ? vec2(-9.0, 0.0) : vec2(0.0, gl_VertexIndex == 0 ? -9.0 : 9.0), 0.5, 1.0);
}
