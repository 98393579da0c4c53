#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D transmittance;
layout(set = 0, binding = 1) uniform sampler2D multi;
layout(set = 0, binding = 2, rgba16f) writeonly uniform image2D target;
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    const vec2 uv = (vec2(at) + 0.5) / vec2(imageSize(target));
    imageStore(target, at, textureLod(transmittance, uv, 0.0) + textureLod(multi, uv, 0.0));
}
