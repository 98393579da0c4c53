#version 460
layout(local_size_x = 8, local_size_y = 8) in;
layout(set = 0, binding = 0) uniform sampler2D source;
layout(set = 0, binding = 1, r32f) uniform writeonly image2D targets[2];

void main() {
    ivec2 at = ivec2(gl_GlobalInvocationID.xy);
    if (all(lessThan(at, imageSize(targets[0])))) {
        float value = texelFetch(source, at, 0).r;
        imageStore(targets[0], at, vec4(2.0 * value));
        imageStore(targets[1], at, vec4(3.0 * value));
    }
}
