#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/lighting.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;

layout(location = 0) out vec4 color;

// What all lights come to, one after the other.
void main() {
    const vec3 facing = direction_of(gl_FrontFacing ? world_normal : -world_normal);
    vec3 light = vec3(0.0);
    for (uint i = 0u; i < lights.point_light_count; ++i) {
        light += from_point(lights.point_lights[i], world_position, facing);
    }
    color = vec4(light, float(lights.point_light_count));
}
