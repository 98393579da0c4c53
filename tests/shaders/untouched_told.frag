#version 460
// Whether it is told that several samples are covered. Lavapipe of Mesa 22.3.6 tells of two of four.
layout(location = 0) out vec4 color;
void main() { color = vec4(bitCount(gl_SampleMaskIn[0]) > 1 ? 1.0 : 0.0, 0.0, 0.0, 1.0); }
