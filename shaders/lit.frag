#version 460
#extension GL_GOOGLE_include_directive : require

#ifdef HAS_sun_shadow
// Depth of what casts the sun's shadows, one layer for each cascade. It may be left out, and `shadow_taps` with it.
layout(set = 0, binding = 0) uniform TEXTURE_sun_shadow sun_shadow;
layout(set = 0, binding = 8) uniform Params {
    // Width of the filter at the edges of shadows in texels of the map, 1 to 7.
    int shadow_taps;
} params;
#endif

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
