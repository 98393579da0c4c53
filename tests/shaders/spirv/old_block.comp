#version 450
layout(local_size_x = 4) in;
layout(set = 0, binding = 0) readonly buffer From { uint from[]; };
layout(set = 0, binding = 1) buffer To { uint to[]; };
layout(set = 0, binding = 2) uniform Unused { vec4 unused; };

void main() {
    to[gl_GlobalInvocationID.x] = from[gl_GlobalInvocationID.x] + 1u;
}
