#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler3D scattered;
layout(set = 0, binding = 1, rgba16f) writeonly uniform image3D target;
void main() {
    const ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (any(greaterThanEqual(at, imageSize(target).xy))) { return; }
    vec3 sum = vec3(0.0); float through = 1.0;
    for (int z = 0; z < imageSize(target).z; ++z) {
        const vec4 here = texelFetch(scattered, ivec3(at, z), 0);
        sum += through * here.rgb * (1.0 - exp(-here.a)); through *= exp(-here.a);
        imageStore(target, ivec3(at, z), vec4(sum, through));
    }
}
