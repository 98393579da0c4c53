#version 460
// A triangle whose upright side goes through the fifth column of eight: two of its four samples are to the left.
void main() {
    const vec2 places[3] = vec2[3](vec2(0.1125, -9.0), vec2(0.1125, 9.0), vec2(-9.0, 0.0));
    gl_Position = vec4(places[gl_VertexIndex], 0.0, 1.0);
}
