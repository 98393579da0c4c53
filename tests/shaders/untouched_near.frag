#version 460
// Samples of the left half alone.
layout(location = 0) out vec4 color;
void main() {
    gl_SampleMask[0] = gl_FragCoord.x < 4.0 ? -1 : 0;
    color = vec4(1.0, 0.0, 0.0, 1.0);
}
