#version 460

// Four middles of texels in a picture of 16 by 8: the ends of the third row, but for its first and last texel, and of the sixth, backwards.
void main() {
    const vec2 texels[4] = vec2[4](vec2(1.5, 2.5), vec2(14.5, 2.5), vec2(14.5, 5.5), vec2(1.5, 5.5));
    gl_Position = vec4(texels[gl_VertexIndex] / vec2(8.0, 4.0) - 1.0, 0.5, 1.0);
    gl_PointSize = 1.0;
}
