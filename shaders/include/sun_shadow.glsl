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

#ifdef HAS_sun_shadow

#include "include/texture.glsl"

// What rounding of depth may come to, as a share of the depth that a map covers: two steps of 16 bits.
const float DEPTH_ROUNDING = 1.0 / 32768.0;
// The last share of the reach, along which shadows fade.
const float FADING = 0.1;

// The share of `taps` × `taps` texels around a place (in texels of the map), each as large as a texel, that no caster covers:
// percentage-closer filtering (W. T. Reeves, D. H. Salesin, R. L. Cook, "Rendering antialiased shadows with depth maps",
// SIGGRAPH 1987) with a box for a filter.
float uncovered(vec2 place, int layer, float depth, int taps) {
    const vec2 corner = place - 0.5 * float(taps);
    const ivec2 first = ivec2(floor(corner));
    const vec2 beyond = corner - vec2(first);
    float share = 0.0;
    for (int y = 0; y <= taps; ++y) {
        const float rows = y == 0 ? 1.0 - beyond.y : y == taps ? beyond.y : 1.0;
        for (int x = 0; x <= taps; ++x) {
            const float columns = x == 0 ? 1.0 - beyond.x : x == taps ? beyond.x : 1.0;
            const float caster = texel_of(sun_shadow, first + ivec2(x, y), layer, 0).r;
            share += caster > depth ? 0.0 : rows * columns;
        }
    }
    return share / float(taps * taps);
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
    // The rise of the surface between the place and the farthest texel that is looked up, in texels.
    const float rise = sqrt(2.0) * 0.5 * float(taps + 1) * sqrt(max(1.0 - facing * facing, 0.0));
    const ivec2 extent = extent_of(sun_shadow);
    for (int layer = 0; layer < int(cascades.count); ++layer) {
        const Cascade cascade = cascades.cascade[layer];
        const vec4 seen = cascade.world_to_clip * vec4(position + normal * (rise * cascade.texel), 1.0);
        const vec2 place = (seen.xy * 0.5 + 0.5) * vec2(extent);
        const float margin = 0.5 * float(taps) + 1.0;
        if (all(greaterThan(place, vec2(margin))) && all(lessThan(place, vec2(extent) - margin))) {
            const float fading = clamp((1.0 - distance_share) / FADING, 0.0, 1.0);
            return mix(1.0, uncovered(place, layer, seen.z + DEPTH_ROUNDING, taps), fading);
        }
    }
#endif
    return 1.0;
}

#endif
