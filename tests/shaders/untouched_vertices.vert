#version 460
// A triangle whose upright side is the middle of the picture.
void main() {
    const vec2 places[3] = vec2[3](vec2(0.0, -9.0), vec2(0.0, 9.0), vec2(-9.0, 0.0));
    gl_Position = vec4(places[gl_VertexIndex], 0.0, 1.0);
}
