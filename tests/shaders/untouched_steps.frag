#version 460
// One more sample of four in each quarter, from left to right.
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    gl_SampleMask[0] = (2 << int(4.0 * uv.x)) - 1;
    color = vec4(1.0, 0.0, 0.0, 1.0);
}
