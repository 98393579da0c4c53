// Images of which a pass may see only a part, in HLSL and Slang: the twin of part.glsl, and of levels.glsl for their mip levels. NAME_st stands
// for the part of the image that the pass gives as NAME: how wide and high it is, as shares of the image, and where it begins.
#ifndef FRAMEWRIGHT_PART
#define FRAMEWRIGHT_PART

#ifdef FRAMEWRIGHT_PARTS
struct FramewrightParts {
    float4 st[FRAMEWRIGHT_PARTS];
};
[[vk::push_constant]] ConstantBuffer<FramewrightParts> framewright_parts;
#endif

// Whether the part is all of its image.
bool is_whole(float4 st) {
    return st.x == 1.0 && st.y == 1.0 && st.z == 0.0 && st.w == 0.0;
}

// A place in the part, 0 to 1 from its upper left corner, as a place in its image.
float2 uv_adjust(float2 uv, float4 st) {
    return uv * st.xy + st.zw;
}

// A place in an image as a place in its part.
float2 uv_unadjust(float2 uv, float4 st) {
    return (uv - st.zw) / st.xy;
}

// The place within the part that is nearest to a place in the image, whose extent is `texels`. A linear filter mixes in no texel beyond the
// part.
float2 uv_clamp(float2 uv, float4 st, int2 texels) {
    float2 margin = min((0.5 + 1.0 / 512.0) / float2(texels), 0.5 * st.xy);
    float2 within = clamp(uv, st.zw + margin, st.zw + st.xy - margin);
    return float2(st.x == 1.0 ? uv.x : within.x, st.y == 1.0 ? uv.y : within.y);
}

// The first texel of the part, in an image whose extent is `texels`.
int2 part_origin(int2 texels, float4 st) {
    return is_whole(st) ? int2(0, 0) : int2(round(float2(texels) * st.zw));
}

// The extent of the part in texels, in an image whose extent is `texels`.
int2 part_extent(int2 texels, float4 st) {
    return is_whole(st) ? texels : int2(round(float2(texels) * st.xy));
}

// The extent of the part in a mip level whose extent is `texels`. In the first level that the pass gives, the part has the extent `used`.
int2 part_level(int2 used, int2 texels, int level) {
    return clamp(used >> level, min(int2(2, 2), texels), texels);
}

// A place in the part of a level whose extent is `texels`, 0 to 1 from its upper left corner, as a place in the level. The part has the
// extent `used` there. A linear filter mixes in no texel beyond it.
float2 uv_in_level(float2 uv, int2 used, int2 texels) {
    float2 margin = min(float2(0.5, 0.5) + 1.0 / 512.0, 0.5 * float2(used));
    float2 within = clamp(uv * float2(used), margin, float2(used) - margin) / float2(texels);
    return float2(used.x == texels.x ? uv.x : within.x, used.y == texels.y ? uv.y : within.y);
}

#endif
