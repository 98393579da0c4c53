// Images whose declaration is left to the pass, which knows what it gives:
//
//     layout(set = 0, binding = 0) uniform TEXTURE_source source;
//
// Every function is there for images that are flat, have layers, have samples, or have both, of floating point and of
// integers, so a shader is written once for all of them. Texels, layers and samples are counted from 0.
//
//     ivec2 extent_of(image)                          width and height in texels
//     int layers_of(image), samples_of(image)         how many there are
//     vec4 texel_of(image, texel, layer, number)      a sample of a texel of a layer; uvec4 of integers
//     vec4 found_at(image, uv, layer, number)         what lies at a place, 0 to 1 from the upper left corner, filtered as the
//                                                     pass says; of samples the one of the texel around the place
//     ivec2 used_of(image, st)                        width and height of the part that is seen; see part.glsl
//     vec4 texel_in(image, st, texel, layer, number)  a sample of a texel of that part
//     vec4 texel_in(image, st, texel)                 the same, of an image without layers or samples
//     vec4 found_in(image, st, uv, layer, number)     what lies at a place of the part, 0 to 1 from its upper left corner
//     vec4 found_in(image, st, uv)                    the same, of an image without layers or samples
//
// What has no layers or samples ignores their number. A filter of the device makes NaN of an infinite texel, even where that counts
// for nothing: `found_at` and `found_in` mix the guarded texels (radiance.glsl) by themselves there. Where the filter is `Nearest` they
// guard the texel that it finds. Alpha is left as it is found.
#ifndef FRAMEWRIGHT_TEXTURE
#define FRAMEWRIGHT_TEXTURE

#include "include/part.glsl"
#include "include/radiance.glsl"

// The texel around a place of an image; beyond its edges the outermost one.
ivec2 texel_at(vec2 uv, ivec2 extent) {
    return clamp(ivec2(floor(uv * vec2(extent))), ivec2(0), extent - 1);
}

// The four texels around a place, which a linear filter mixes.
struct Footprint {
    // The place between them, in texels.
    vec2 middle;
    // How much the right and lower ones count, in the steps of 1/256 that devices filter by; less than 1.
    vec2 share;
};

Footprint footprint_at(vec2 uv, ivec2 extent) {
    const vec2 from_centers = round((uv * vec2(extent) - 0.5) * 256.0) / 256.0;
    const vec2 upper_left = floor(from_centers);
    return Footprint(upper_left + 1.0, from_centers - upper_left);
}

// One channel of what a sampler found. Where that isn't finite: the guarded texel itself if the filter is `Nearest`, else the mean
// of the four guarded texels `around` (in the order of `textureGather`). `quarters` is what the sampler finds a quarter of a texel
// from the middle, within each of the four. `Nearest` finds these four texels there. A linear filter mixes all four of them at each
// of these places: where one of them isn't finite it finds NaN everywhere, or the same infinity.
float mended(float found, vec4 around, vec4 quarters, vec2 share) {
    if (all_finite(vec3(found))) {
        return found;
    }
    const vec4 quarter = guard_signed(quarters);
    if (!all_finite(around) && any(notEqual(quarter, quarter.xxxx))) {
        return guard_signed(found);
    }
    const vec4 guarded = guard_signed(around);
    return mix(mix(guarded.w, guarded.z, share.x), mix(guarded.x, guarded.y, share.x), share.y);
}

// The place itself but for its horizontal and vertical coordinate.
vec2 moved(vec2 place, vec2 uv) { return uv; }
vec3 moved(vec3 place, vec2 uv) { return vec3(uv, place.z); }

#define FRAMEWRIGHT_FILTERED(IMAGE, PLACE) \
    vec3 quarter_of(IMAGE image, PLACE place, vec2 texels) { \
        return textureLod(image, moved(place, texels / vec2(textureSize(image, 0).xy)), 0.0).rgb; \
    } \
    vec4 filtered(IMAGE image, PLACE place) { \
        vec4 found = textureLod(image, place, 0.0); \
        if (!all_finite(found.rgb)) { \
            const ivec2 extent = textureSize(image, 0).xy; \
            const Footprint footprint = footprint_at(place.xy, extent); \
            const vec2 middle = footprint.middle; \
            const mat3x4 quarters = transpose(mat4x3( \
                quarter_of(image, place, middle - 0.25), quarter_of(image, place, middle + vec2(0.25, -0.25)), \
                quarter_of(image, place, middle + vec2(-0.25, 0.25)), quarter_of(image, place, middle + 0.25) \
            )); \
            const PLACE between = moved(place, middle / vec2(extent)); \
            found.r = mended(found.r, textureGather(image, between, 0), quarters[0], footprint.share); \
            found.g = mended(found.g, textureGather(image, between, 1), quarters[1], footprint.share); \
            found.b = mended(found.b, textureGather(image, between, 2), quarters[2], footprint.share); \
        } \
        return found; \
    }

FRAMEWRIGHT_FILTERED(sampler2D, vec2)
FRAMEWRIGHT_FILTERED(sampler2DArray, vec3)
uvec4 filtered(usampler2D image, vec2 place) { return textureLod(image, place, 0.0); }
uvec4 filtered(usampler2DArray image, vec3 place) { return textureLod(image, place, 0.0); }

#define FRAMEWRIGHT_TEXELS(COLOR, FLAT, LAYERED, SAMPLED, BOTH) \
    ivec2 extent_of(FLAT image) { return textureSize(image, 0); } \
    ivec2 extent_of(LAYERED image) { return textureSize(image, 0).xy; } \
    ivec2 extent_of(SAMPLED image) { return textureSize(image); } \
    ivec2 extent_of(BOTH image) { return textureSize(image).xy; } \
    int layers_of(FLAT image) { return 1; } \
    int layers_of(LAYERED image) { return textureSize(image, 0).z; } \
    int layers_of(SAMPLED image) { return 1; } \
    int layers_of(BOTH image) { return textureSize(image).z; } \
    int samples_of(FLAT image) { return 1; } \
    int samples_of(LAYERED image) { return 1; } \
    int samples_of(SAMPLED image) { return textureSamples(image); } \
    int samples_of(BOTH image) { return textureSamples(image); } \
    COLOR texel_of(FLAT image, ivec2 texel, int layer, int number) { return texelFetch(image, texel, 0); } \
    COLOR texel_of(LAYERED image, ivec2 texel, int layer, int number) { \
        return texelFetch(image, ivec3(texel, layer), 0); \
    } \
    COLOR texel_of(SAMPLED image, ivec2 texel, int layer, int number) { return texelFetch(image, texel, number); } \
    COLOR texel_of(BOTH image, ivec2 texel, int layer, int number) { \
        return texelFetch(image, ivec3(texel, layer), number); \
    } \
    COLOR found_at(FLAT image, vec2 uv, int layer, int number) { return filtered(image, uv); } \
    COLOR found_at(LAYERED image, vec2 uv, int layer, int number) { \
        return filtered(image, vec3(uv, float(layer))); \
    } \
    COLOR found_at(SAMPLED image, vec2 uv, int layer, int number) { \
        return texel_of(image, texel_at(uv, extent_of(image)), layer, number); \
    } \
    COLOR found_at(BOTH image, vec2 uv, int layer, int number) { \
        return texel_of(image, texel_at(uv, extent_of(image)), layer, number); \
    } \
    FRAMEWRIGHT_PART_OF(COLOR, FLAT) \
    FRAMEWRIGHT_PART_OF(COLOR, LAYERED) \
    FRAMEWRIGHT_PART_OF(COLOR, SAMPLED) \
    FRAMEWRIGHT_PART_OF(COLOR, BOTH) \
    COLOR texel_in(FLAT image, vec4 st, ivec2 texel) { return texel_in(image, st, texel, 0, 0); } \
    COLOR found_in(FLAT image, vec4 st, vec2 uv) { return found_in(image, st, uv, 0, 0); }

#define FRAMEWRIGHT_PART_OF(COLOR, IMAGE) \
    ivec2 used_of(IMAGE image, vec4 st) { return part_extent(extent_of(image), st); } \
    COLOR texel_in(IMAGE image, vec4 st, ivec2 texel, int layer, int number) { \
        return texel_of(image, texel + part_origin(extent_of(image), st), layer, number); \
    } \
    COLOR found_in(IMAGE image, vec4 st, vec2 uv, int layer, int number) { \
        return found_at(image, uv_clamp(uv_adjust(uv, st), st, extent_of(image)), layer, number); \
    }

FRAMEWRIGHT_TEXELS(vec4, sampler2D, sampler2DArray, sampler2DMS, sampler2DMSArray)
FRAMEWRIGHT_TEXELS(uvec4, usampler2D, usampler2DArray, usampler2DMS, usampler2DMSArray)

#endif
