#version 460
layout(local_size_x = 64) in;
struct Particle { vec4 place; vec4 speed; };
layout(set = 0, binding = 0, std430) readonly buffer State { Particle particle[]; } state;
layout(set = 0, binding = 1, std430) buffer Alive { uint number[]; } alive;
layout(set = 0, binding = 2, std430) buffer Args { uint vertices; uint count; uint first_vertex; uint first_instance; } args;
layout(set = 0, binding = 3) uniform Params { uint count; } params;
void main() {
    const uint i = gl_GlobalInvocationID.x;
    if (i == 0u) { args.vertices = 6u; }
    if (i < params.count && state.particle[i].place.w > 0.0) { alive.number[atomicAdd(args.count, 1u)] = i; }
}
