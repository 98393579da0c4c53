#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/lighting.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;

layout(location = 0) out vec4 color;

// What the lists of clusters come to.
void main() {
    const vec3 facing = direction_of(gl_FrontFacing ? world_normal : -world_normal);
    vec3 light = vec3(0.0);
    const Reach reach = reach_of(world_position);
    for (uint i = 0u; i < reach.count; ++i) {
        light += from_point(light_of(reach, i), world_position, facing);
    }
    color = vec4(light, float(reach.count));
}
