#version 460

layout(local_size_x = 64) in;

// A word a texel, as a buffer holds depth.
layout(set = 0, binding = 0, std430) writeonly buffer Depths {
    uint word[64];
} depths;
// A byte a texel, as a buffer holds stencil.
layout(set = 0, binding = 1, std430) writeonly buffer Marks {
    uint word[16];
} marks;
layout(set = 0, binding = 2) uniform Params {
    // Whether depth is a whole number of 24 bits.
    uint packed;
} params;

// Depths below 1 in 64 steps, and stencils, by the number of the texel.
void main() {
    const uint texel = gl_LocalInvocationIndex;
    depths.word[texel] = params.packed == 1u ? (texel << 18) + texel : floatBitsToUint(float(texel + 1u) / 64.0);
    if (texel < 16u) {
        const uvec4 mark = (11u * (4u * texel + uvec4(0u, 1u, 2u, 3u)) + 5u) & 255u;
        marks.word[texel] = mark.x | mark.y << 8 | mark.z << 16 | mark.w << 24;
    }
}
