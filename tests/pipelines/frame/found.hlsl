// What shaders of this frame look up in images of which a frame may use a part: the twin of include/texture.glsl and include/levels.glsl.
#include "include/part.hlsl"

// Width and height of the part of an image that is used: `st` stands for the part.
#define USED(IMAGE) \
    int2 used_of(IMAGE image, float4 st) { \
        uint2 extent; \
        image.GetDimensions(extent.x, extent.y); \
        return part_extent(int2(extent), st); \
    }

// What lies at a place of the part, 0 to 1 from its upper left corner; the same in one of the image's mip levels.
#define FOUND(TEXEL, IMAGE) \
    USED(IMAGE) \
    TEXEL found_in(IMAGE image, SamplerState filtered, float4 st, float2 uv) { \
        uint2 extent; \
        image.GetDimensions(extent.x, extent.y); \
        return image.SampleLevel(filtered, uv_clamp(uv_adjust(uv, st), st, int2(extent)), 0); \
    } \
    int2 used_of_level(IMAGE image, float4 st, int level) { \
        uint width, height, levels; \
        image.GetDimensions(level, width, height, levels); \
        return part_level(used_of(image, st), int2(width, height), level); \
    } \
    TEXEL found_in_level(IMAGE image, SamplerState filtered, float4 st, float2 uv, int level) { \
        uint width, height, levels; \
        image.GetDimensions(level, width, height, levels); \
        return image.SampleLevel(filtered, uv_in_level(uv, used_of_level(image, st, level), int2(width, height)), level); \
    }

USED(Texture2D<uint>)
FOUND(float, Texture2D<float>)
FOUND(float2, Texture2D<float2>)
FOUND(float4, Texture2D<float4>)
