#version 460

layout(local_size_x = 8, local_size_y = 4) in;

layout(set = 0, binding = 0, r32ui) uniform writeonly uimage2D to;

// The number of each texel. Those beyond the part in use get one as well.
void main() {
    const ivec2 here = ivec2(gl_GlobalInvocationID.xy);
    imageStore(to, here, uvec4(1000 * here.y + here.x));
}
