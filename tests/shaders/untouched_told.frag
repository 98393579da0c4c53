#version 460
// How many of four samples it is told are covered.
layout(location = 0) out vec4 color;
void main() { color = vec4(float(bitCount(gl_SampleMaskIn[0])) / 4.0, 0.0, 0.0, 1.0); }
