#version 460
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 0) uniform sampler2D transmittance;
layout(set = 0, binding = 1) uniform sampler2D multi;
layout(set = 0, binding = 2, rgba16f) writeonly uniform image3D target;
void main() {
    const ivec3 at = ivec3(gl_GlobalInvocationID);
    const vec3 uv = (vec3(at) + 0.5) / vec3(imageSize(target));
    imageStore(target, at, textureLod(transmittance, uv.xz, 0.0) + textureLod(multi, uv.xy, 0.0));
}
