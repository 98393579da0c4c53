#version 460

// The upper left half of the target: nothing of it is clipped, which could cut it in two.
void main() {
    gl_Position = vec4(gl_VertexIndex == 1 ? 1.0 : -1.0, gl_VertexIndex == 2 ? 1.0 : -1.0, 0.0, 1.0);
}
