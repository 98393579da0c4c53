// The share of the sun's light that no caster keeps away. tests/tests/suite/drawn/shadows.rs holds it against rays to the sun.
//
// A shader that may be given shadow maps declares them before it includes this, one layer for each cascade:
//
//     #ifdef HAS_sun_shadow
//     layout(set = 0, binding = 0) uniform TEXTURE_sun_shadow sun_shadow;
//     layout(set = 0, binding = 8) uniform Params { int shadow_taps; } params;
//     #endif
#ifndef FRAMEWRIGHT_SUN_SHADOW
#define FRAMEWRIGHT_SUN_SHADOW

#include "include/scene.glsl"

// The last share of the reach, along which shadows fade.
const float FADING = 0.1;

// The share of the sun's light that arrives at a share of the reach, 0 to 1, where this much of the filter is uncovered.
float faded(float uncovered, float distance_share) {
    return mix(1.0, uncovered, clamp((1.0 - distance_share) / FADING, 0.0, 1.0));
}

#ifdef HAS_sun_shadow

#include "include/texture.glsl"

// What rounding of depth may come to, as a share of the depth that a map covers: two steps of 16 bits.
const float DEPTH_ROUNDING = 1.0 / 32768.0;
// A place is looked up by this many texels above its surface, times the sine of the angle between its normal and the sun.
const float RISE = 1.0;
// The last share of a cascade's map at each border, along which the next cascade takes over.
const float BLENDING = 0.08;

// The share of `taps` × `taps` texels around a place (in texels of the map), each as large as a texel, that no caster covers:
// percentage-closer filtering (W. T. Reeves, D. H. Salesin, R. L. Cook, "Rendering antialiased shadows with depth maps",
// SIGGRAPH 1987) with a box for a filter. The surface goes on as a plane: its depth is `depth` at the place and changes by `slope`
// a texel (J. R. Isidoro, "Shadow Mapping: GPU-based Tips and Techniques", GDC 2006).
float uncovered(vec2 place, int layer, float depth, vec2 slope, int taps) {
    const vec2 corner = place - 0.5 * float(taps);
    const ivec2 first = ivec2(floor(corner));
    const vec2 beyond = corner - vec2(first);
    float share = 0.0;
    for (int y = 0; y <= taps; ++y) {
        const float rows = y == 0 ? 1.0 - beyond.y : y == taps ? beyond.y : 1.0;
        for (int x = 0; x <= taps; ++x) {
            const float columns = x == 0 ? 1.0 - beyond.x : x == taps ? beyond.x : 1.0;
            const float caster = texel_of(sun_shadow, first + ivec2(x, y), layer, 0).r;
            const float surface = depth + max(dot(slope, vec2(first + ivec2(x, y)) + 0.5 - place), 0.0);
            share += caster > surface ? 0.0 : rows * columns;
        }
    }
    return share / float(taps * taps);
}

#endif

#ifdef HAS_sun_shadow

// How much the depth of a plane with the normal `normal` changes from texel to texel of a map, along its rows and columns.
vec2 slope_of(mat4 world_to_clip, vec3 normal, vec2 extent) {
    const mat3 rows = transpose(mat3(world_to_clip));
    const vec2 along = vec2(dot(rows[0], normal) / dot(rows[0], rows[0]), dot(rows[1], normal) / dot(rows[1], rows[1]));
    return -along * dot(rows[2], rows[2]) / dot(rows[2], normal) * 2.0 / extent;
}

#endif

// Of a surface at `position` with the unit normal `normal`, which faces the camera.
float sunlit(vec3 position, vec3 normal) {
#ifdef HAS_sun_shadow
    const int taps = clamp(params.shadow_taps, 1, 7);
    const float facing = dot(normal, lights.sun_direction);
    const float distance_share = length(position) / cascades.reach;
    if (facing <= 0.0 || distance_share >= 1.0) {
        return 1.0;
    }
    const float rise = RISE * sqrt(max(1.0 - facing * facing, 0.0));
    const vec2 extent = vec2(extent_of(sun_shadow));
    const float margin = 0.5 * float(taps) + 1.0;
    float share = 0.0;
    float rest = 1.0;
    for (int layer = 0; layer < int(cascades.count) && rest > 0.0; ++layer) {
        const Cascade cascade = cascades.cascade[layer];
        const vec4 seen = cascade.world_to_clip * vec4(position + normal * (rise * cascade.texel), 1.0);
        const vec2 place = (seen.xy * 0.5 + 0.5) * extent;
        const vec2 inner = min(place, extent - place) - margin;
        const float from_border = min(inner.x, inner.y);
        if (from_border > 0.0) {
            const bool last = layer + 1 == int(cascades.count);
            const float part = last ? 1.0 : min(from_border / (BLENDING * extent.x), 1.0);
            const vec2 slope = slope_of(cascade.world_to_clip, normal, extent);
            share += rest * part * uncovered(place, layer, seen.z + DEPTH_ROUNDING, slope, taps);
            rest *= 1.0 - part;
        }
    }
    return faded(share + rest, distance_share);
#else
    return 1.0;
#endif
}

#endif
