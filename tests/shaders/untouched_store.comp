#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rgba8) uniform writeonly image2D target;
// Stores into the left half.
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (2 * at.x < imageSize(target).x) {
        imageStore(target, at, vec4(1.0, 0.0, 0.0, 1.0));
    }
}
