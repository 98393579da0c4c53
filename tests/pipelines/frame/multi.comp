#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D transmittance;
layout(set = 0, binding = 1, rgba16f) uniform image2D target;
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(target)))) { return; }
    imageStore(target, at, textureLod(transmittance, vec2(at) / 32.0, 0.0) * 0.5);
}
