#version 460

// A triangle in the lower right corner, wherever that comes to lie.
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 0.0 : 1.0, gl_VertexIndex == 2 ? 0.0 : 1.0, 0.0, 1.0);
}
