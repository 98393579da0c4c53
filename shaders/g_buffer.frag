#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/g_buffer_surface.glsl"
#include "include/material.glsl"

layout(location = 1) in vec3 world_normal;
layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

// The surface of opaque objects: base colour, normal and emitted light, for `deferred_lighting`.
void main() {
    write_surface(object_index, base_color(object_index, texture_uv).rgb, world_normal);
}
