#version 460
layout(local_size_x = 4, local_size_y = 4, local_size_z = 4) in;
layout(set = 0, binding = 0) uniform sampler3D now;
layout(set = 0, binding = 1) uniform sampler3D before;
layout(set = 0, binding = 2, rgba16f) writeonly uniform image3D target;
void main() {
    const ivec3 at = ivec3(gl_GlobalInvocationID);
    if (any(greaterThanEqual(at, imageSize(target)))) { return; }
    imageStore(target, at, mix(textureLod(before, (vec3(at) + 0.5) / vec3(imageSize(target)), 0.0), texelFetch(now, at, 0), 0.1));
}
