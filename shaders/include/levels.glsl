// Mip levels of images, where a frame may use a part of an image: see part.glsl. Levels are counted from the first that the pass gives, and
// NAME_st stands for the part of that one. Each further level uses half as much, rounded down, and at least two texels along each axis
// that has them.
//
//     ivec2 used_of_level(image, st, level)           width and height of the part in a level
//     vec4 texel_in_level(image, texel, layer, level) a texel of a level, counted from the part's first
//     vec4 found_in_level(image, st, uv, layer, level)
//                                                     what lies at a place of the part in a level, 0 to 1 from its upper left corner,
//                                                     filtered as the pass says
//     vec4 found_between(image, st, uv, layer, level) the same between two levels, mixed of both: the level isn't whole
//
// Each level is looked up by itself: a sampler that mixes levels takes one place for both, and of one of them it may lie beyond the part.
// What has no layers ignores their number. Nothing is guarded (radiance.glsl).
//
// Lavapipe takes the level of one fragment for the four of a quad: where levels differ among them, it looks the others up in a wrong one.
#ifndef FRAMEWRIGHT_LEVELS
#define FRAMEWRIGHT_LEVELS

#include "include/part.glsl"

// The extent of the part in a level whose extent is `texels`. In the first level the part has the extent `used`.
ivec2 part_level(ivec2 used, ivec2 texels, int level) {
    return clamp(used >> level, min(ivec2(2), texels), texels);
}

// A place in the part of a level whose extent is `texels`, 0 to 1 from its upper left corner, as a place in the level. The part has the
// extent `used` there. A linear filter mixes in no texel beyond it: see uv_clamp.
vec2 uv_in_level(vec2 uv, ivec2 used, ivec2 texels) {
    const vec2 margin = min(vec2(0.5 + 1.0 / 512.0), 0.5 * vec2(used));
    const vec2 within = clamp(uv * vec2(used), margin, vec2(used) - margin) / vec2(texels);
    return vec2(used.x == texels.x ? uv.x : within.x, used.y == texels.y ? uv.y : within.y);
}

#define FRAMEWRIGHT_LEVELS_OF(IMAGE, TEXEL, PLACE) \
    ivec2 used_of_level(IMAGE image, vec4 st, int level) { \
        return part_level(part_extent(textureSize(image, 0).xy, st), textureSize(image, level).xy, level); \
    } \
    vec4 texel_in_level(IMAGE image, ivec2 texel, int layer, int level) { return texelFetch(image, TEXEL, level); } \
    vec4 found_in_level(IMAGE image, vec4 st, vec2 uv, int layer, int level) { \
        const vec2 place = uv_in_level(uv, used_of_level(image, st, level), textureSize(image, level).xy); \
        return textureLod(image, PLACE, float(level)); \
    } \
    vec4 found_between(IMAGE image, vec4 st, vec2 uv, int layer, float level) { \
        const int last = textureQueryLevels(image) - 1; \
        const float between = clamp(level, 0.0, float(last)); \
        const int first = int(between); \
        const vec4 found = found_in_level(image, st, uv, layer, first); \
        return mix(found, found_in_level(image, st, uv, layer, min(first + 1, last)), fract(between)); \
    }

FRAMEWRIGHT_LEVELS_OF(sampler2D, texel, place)
FRAMEWRIGHT_LEVELS_OF(sampler2DArray, ivec3(texel, layer), vec3(place, float(layer)))

#endif
