#version 460
layout(local_size_x = 1) in;
layout(set = 0, binding = 0, std430) readonly buffer RestCount { uint count; uint pad[3]; } rest_count;
layout(set = 0, binding = 1, std430) writeonly buffer Groups { uvec4 size; } groups;
void main() { groups.size = uvec4((rest_count.count + 63u) / 64u, 1u, 1u, 0u); }
