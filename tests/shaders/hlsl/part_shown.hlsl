// The twin of part_shown.frag.
#include "include/part.hlsl"

Texture2D<float4> now : register(t0);
Texture2D before : register(t1);
SamplerState linear_clamp : register(s0);

int2 texels(Texture2D<float4> source) {
    int2 extent;
    source.GetDimensions(extent.x, extent.y);
    return extent;
}

float4 found(Texture2D<float4> source, float4 st, float2 uv) {
    return source.SampleLevel(linear_clamp, uv_clamp(uv_adjust(uv, st), st, texels(source)), 0.0);
}

float4 PSMain(float4 position : SV_Position, [[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    int2 sizes = part_extent(texels(now), now_st) + 100 * part_extent(texels(before), before_st);
    return float4(found(now, now_st, uv).xy + 0.25 * found(before, before_st, uv).xy, float2(sizes));
}
