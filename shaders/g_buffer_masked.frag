#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/cross_fade.glsl"
#include "include/material.glsl"
#include "include/rotation.glsl"

layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

#ifndef DEPTH_ONLY
#include "include/g_buffer_surface.glsl"

layout(location = 1) in vec3 world_normal;
#endif

// As `g_buffer`, with the holes that alpha and cross-fading cut.
void main() {
    const vec4 base = base_color(object_index, texture_uv);
    if (base.a < objects.object[object_index].alpha_cutoff
        || fades_out(objects.object[object_index].cross_fade, frag_coord().xy)) {
        discard;
    }
#ifndef DEPTH_ONLY
    write_surface(object_index, base.rgb, world_normal);
#endif
}
