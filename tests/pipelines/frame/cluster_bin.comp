#version 460
layout(local_size_x = 1) in;
layout(constant_id = 0) const uint ACROSS = 1u;
layout(constant_id = 1) const uint DOWN = 1u;
layout(constant_id = 2) const uint LIGHTS = 1u;
layout(set = 0, binding = 0, std430) readonly buffer Bounds { vec4 box[]; } bounds;
layout(set = 0, binding = 1, std430) readonly buffer Lights { vec4 light[]; } lights;
layout(set = 0, binding = 2, std430) buffer Used { uint count; uint pad[3]; } used;
layout(set = 0, binding = 3, std430) writeonly buffer Grid { uvec2 range[]; } grid;
layout(set = 0, binding = 4, std430) buffer Items { uint number[]; } items;
void main() {
    const uint at = gl_GlobalInvocationID.x + ACROSS * (gl_GlobalInvocationID.y + DOWN * gl_GlobalInvocationID.z);
    uint found = 0u;
    for (uint i = 0u; i < LIGHTS; ++i) { found += lights.light[2u * i].w > 0.0 && distance(lights.light[2u * i].xyz, bounds.box[2u * at].xyz) < lights.light[2u * i].w ? 1u : 0u; }
    const uint first = atomicAdd(used.count, found);
    grid.range[at] = uvec2(first, found);
    for (uint i = 0u; i < found && first + i < uint(items.number.length()); ++i) { items.number[first + i] = i; }
}
