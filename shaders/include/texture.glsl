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
// What has no layers or samples ignores their number.
#ifndef FRAMEWRIGHT_TEXTURE
#define FRAMEWRIGHT_TEXTURE

#include "include/part.glsl"

// The texel around a place of an image; beyond its edges the outermost one.
ivec2 texel_at(vec2 uv, ivec2 extent) {
    return clamp(ivec2(floor(uv * vec2(extent))), ivec2(0), extent - 1);
}

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
    COLOR found_at(FLAT image, vec2 uv, int layer, int number) { return textureLod(image, uv, 0.0); } \
    COLOR found_at(LAYERED image, vec2 uv, int layer, int number) { \
        return textureLod(image, vec3(uv, float(layer)), 0.0); \
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
