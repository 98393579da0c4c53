#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) buffer Clock { uint frame; uint pad[3]; } clock;
layout(set = 0, binding = 1, std430) writeonly buffer Once { uvec4 size[4]; } once;
layout(set = 0, binding = 2) uniform Params { uint instances; } params;
void main() {
    const uint first = clock.frame == 0u ? 1u : 0u;
    once.size[0] = uvec4((params.instances + 63u) / 64u, 1, 1, 0) * first;
    once.size[1] = uvec4(32, 8, 1, 0) * first;
    once.size[2] = uvec4(8, 8, 1, 0) * first;
    once.size[3] = uvec4(0);
    clock.frame += 1u;
    clock.pad[0] = 0u; clock.pad[1] = 0u; clock.pad[2] = 0u;
}
