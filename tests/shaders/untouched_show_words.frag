#version 460
layout(set = 0, binding = 0, std430) readonly buffer Data { uint word[]; } data;
layout(location = 0) out vec4 color;
// Red for 2, green for 1.
void main() {
    const uint word = data.word[8 * int(gl_FragCoord.y) + int(gl_FragCoord.x)];
    color = vec4(word == 2u ? 1.0 : 0.0, word == 1u ? 1.0 : 0.0, word > 2u ? 1.0 : 0.0, 1.0);
}
