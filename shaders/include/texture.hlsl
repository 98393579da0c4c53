// Images of which a pass may see only a part, in one call, in HLSL and Slang: the twin of texture.glsl. Images are declared by their
// types, `Texture2D` or `Texture2D<float2>` for instance, and looked up with a sampler of the shader's. Texels, layers and samples are counted from 0.
//
//     int2 extent_of(image)                                  width and height in texels
//     int2 used_of(image, st)                                width and height of the part that is seen; see part.hlsl
//     int2 texel_at(uv, extent)                              the texel around a place; beyond the edges the outermost one
//     float4 texel_in(image, st, texel)                      a texel of that part
//     float4 texel_in(image, st, texel, layer)               the same in a layer of a `Texture2DArray`
//     float4 texel_in(image, st, texel, number)              a sample of it in a `Texture2DMS`
//     float4 found_in(image, sampler, st, uv)                what lies at a place of the part, 0 to 1 from its upper left corner
//     float4 found_in(image, sampler, st, uv, layer)         the same in a layer of a `Texture2DArray`
//
// Images hold `float`, `uint` or `int`, of one to four components, and what is looked up has the same type. `found_in` takes those of `float` alone.
// Nothing is guarded: where texels are infinite, a filter of the device makes NaN of them. Mip levels below the first aren't looked up.
#ifndef FRAMEWRIGHT_TEXTURE
#define FRAMEWRIGHT_TEXTURE

#include "include/part.hlsl"

// The texel around a place of an image.
int2 texel_at(float2 uv, int2 extent) {
    return clamp(int2(floor(uv * float2(extent))), int2(0, 0), extent - 1);
}

#define FRAMEWRIGHT_TEXELS(COLOR) \
    int2 extent_of(Texture2D<COLOR> image) { \
        uint2 texels; \
        image.GetDimensions(texels.x, texels.y); \
        return int2(texels); \
    } \
    int2 extent_of(Texture2DArray<COLOR> image) { \
        uint3 texels; \
        image.GetDimensions(texels.x, texels.y, texels.z); \
        return int2(texels.xy); \
    } \
    int2 extent_of(Texture2DMS<COLOR> image) { \
        uint3 texels; \
        image.GetDimensions(texels.x, texels.y, texels.z); \
        return int2(texels.xy); \
    } \
    int2 used_of(Texture2D<COLOR> image, float4 st) { return part_extent(extent_of(image), st); } \
    int2 used_of(Texture2DArray<COLOR> image, float4 st) { return part_extent(extent_of(image), st); } \
    int2 used_of(Texture2DMS<COLOR> image, float4 st) { return part_extent(extent_of(image), st); } \
    COLOR texel_in(Texture2D<COLOR> image, float4 st, int2 texel) { \
        return image.Load(int3(texel + part_origin(extent_of(image), st), 0)); \
    } \
    COLOR texel_in(Texture2DArray<COLOR> image, float4 st, int2 texel, int layer) { \
        return image.Load(int4(texel + part_origin(extent_of(image), st), layer, 0)); \
    } \
    COLOR texel_in(Texture2DMS<COLOR> image, float4 st, int2 texel, int number) { \
        return image.Load(texel + part_origin(extent_of(image), st), number); \
    }

#define FRAMEWRIGHT_FOUND(COLOR) \
    COLOR found_in(Texture2D<COLOR> image, SamplerState filtered, float4 st, float2 uv) { \
        return image.SampleLevel(filtered, uv_clamp(uv_adjust(uv, st), st, extent_of(image)), 0.0); \
    } \
    COLOR found_in(Texture2DArray<COLOR> image, SamplerState filtered, float4 st, float2 uv, int layer) { \
        float2 place = uv_clamp(uv_adjust(uv, st), st, extent_of(image)); \
        return image.SampleLevel(filtered, float3(place, float(layer)), 0.0); \
    }

FRAMEWRIGHT_TEXELS(float4)
FRAMEWRIGHT_TEXELS(float3)
FRAMEWRIGHT_TEXELS(float2)
FRAMEWRIGHT_TEXELS(float)
FRAMEWRIGHT_TEXELS(uint4)
FRAMEWRIGHT_TEXELS(uint3)
FRAMEWRIGHT_TEXELS(uint2)
FRAMEWRIGHT_TEXELS(uint)
FRAMEWRIGHT_TEXELS(int4)
FRAMEWRIGHT_TEXELS(int3)
FRAMEWRIGHT_TEXELS(int2)
FRAMEWRIGHT_TEXELS(int)
FRAMEWRIGHT_FOUND(float4)
FRAMEWRIGHT_FOUND(float3)
FRAMEWRIGHT_FOUND(float2)
FRAMEWRIGHT_FOUND(float)

#endif
