// The twin of eyes_sampled.frag.
#include "include/part.hlsl"
#include "include/rotation.hlsl"

Texture2D<float4> source : register(t0);
Texture2D<float4> shared_by_eyes : register(t1);
SamplerState linear_clamp : register(s0);

float4 found(Texture2D<float4> image, float4 st, float2 uv) {
    uint2 texels;
    image.GetDimensions(texels.x, texels.y);
    return image.SampleLevel(linear_clamp, uv_clamp(uv_adjust(uv, st), st, int2(texels)), 0.0);
}

float4 PSMain(float4 position : SV_Position, [[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    uint2 texels;
    source.GetDimensions(texels.x, texels.y);
    float4 smoothed = found(source, source_st, uv + 0.3 / float2(texels));
    int2 origin = part_origin(int2(texels), source_st);
    float4 own = source.Load(int3(origin + int2(frag_coord(position).xy), 0));
    float4 shared_color = shared_by_eyes.SampleLevel(linear_clamp, uv, 0.0);
    return smoothed + 4.0 * own + float4(float2(part_extent(int2(texels), source_st)), 0.0, 0.0) + shared_color;
}
