#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0, rg16f) uniform image2D target;
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(target)))) { return; }
    imageStore(target, at, vec4(vec2(at) / vec2(imageSize(target)), 0.5, 1.0));
}
