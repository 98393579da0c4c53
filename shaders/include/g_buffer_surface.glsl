// Writes the surface of an object into the G-buffer.
#ifndef FRAMEWRIGHT_G_BUFFER_SURFACE
#define FRAMEWRIGHT_G_BUFFER_SURFACE

#include "include/g_buffer.glsl"
#include "include/lighting.glsl"
#include "include/radiance.glsl"

layout(location = 0) out vec4 g_base_color;
layout(location = 1) out vec2 g_normal;
layout(location = 2) out vec4 g_emissive;

void write_surface(uint object_index, vec3 base_color, vec3 normal) {
    g_base_color = vec4(guard_radiance(base_color), 1.0);
    g_normal = guard_signed(octahedral(direction_of(gl_FrontFacing ? normal : -normal)));
    g_emissive = vec4(guard_radiance(objects.object[object_index].emissive), 1.0);
}

#endif
