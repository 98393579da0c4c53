#version 460
layout(local_size_x = 8, local_size_y = 8) in;
// A word for each texel of 8 in a row.
layout(set = 0, binding = 0, std430) writeonly buffer Data { uint word[]; } data;
// Writes the left half of each row.
void main() {
    const uvec2 at = gl_GlobalInvocationID.xy;
    if (at.x < 4u) {
        data.word[8u * at.y + at.x] = 2u;
    }
}
