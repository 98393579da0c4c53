#version 460

// A triangle over all of the picture. Its depth is 0.25 at the left edge and 0.5 at the right one.
void main() {
    vec2 place = vec2((gl_VertexIndex << 1) & 2, gl_VertexIndex & 2);
    gl_Position = vec4(place * 2.0 - 1.0, 0.25 + 0.25 * place.x, 1.0);
}
