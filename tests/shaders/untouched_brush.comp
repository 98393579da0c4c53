#version 460
layout(local_size_x = 4, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba8) uniform writeonly image2D target;
// Stores into four columns at the left.
void main() { imageStore(target, ivec2(gl_GlobalInvocationID.xy), vec4(1.0, 0.0, 0.0, 1.0)); }
