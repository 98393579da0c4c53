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

#include "include/cross_fade.glsl"
#include "include/material.glsl"
#include "include/rotation.glsl"

layout(location = 2) in vec2 texture_uv;
layout(location = 3) flat in uint object_index;

#ifdef ALPHA_TO_COVERAGE
#include "include/alpha_coverage.glsl"
#endif

#ifndef DEPTH_ONLY
#include "include/surface.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;

layout(location = 0) out vec4 color;
#endif

// As `lit`, with the holes that alpha and cross-fading cut. For a pass with `alpha_to_coverage` too: then their edges have as
// many steps as there are samples.
void main() {
    const vec4 base = base_color(object_index, texture_uv);
    const float cutoff = objects.object[object_index].alpha_cutoff;
#ifdef ALPHA_TO_COVERAGE
    // Taken before anything is discarded, as neighbours are compared. Alpha is looked up a pixel further on rather than
    // differentiated: that would compare this pixel with the other ones of its square of two by two, and which ones these are
    // depends on where the picture lies in what is drawn into.
    const float right = base_color(object_index, texture_uv + ddx(texture_uv)).a;
    const float below = base_color(object_index, texture_uv + ddy(texture_uv)).a;
    const float covered = covered_by(base.a, cutoff, abs(right - base.a) + abs(below - base.a));
    const bool is_hole = covered == 0.0;
#else
    const bool is_hole = base.a < cutoff;
#endif
    if (is_hole || fades_out(objects.object[object_index].cross_fade, frag_coord().xy)) {
        discard;
    }
#ifndef DEPTH_ONLY
    color = lit_surface(object_index, base, world_position, world_normal);
#endif
#ifdef ALPHA_TO_COVERAGE
    color.a = guard_alpha(covered);
#endif
}
