#version 460

// A triangle over all of the picture, in front of the near plane.
void main() {
    vec2 place = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(place * 2.0 - 1.0, 1.5, 1.0);
}
