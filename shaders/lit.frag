#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/material.glsl"
#include "include/surface.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

layout(location = 0) out vec4 color;

// Objects in the light of the scene's sun, sky and point lights, in radiance; what lets light through is premultiplied.
void main() {
    color = lit_surface(object_index, base_color(object_index, texture_uv), world_position, world_normal);
}
