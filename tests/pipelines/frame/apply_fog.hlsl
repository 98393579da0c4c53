#include "found.hlsl"

Texture2D source;
Texture2D<float> depth;
Texture3D fog;
SamplerState near;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float away = clamp(0.02 / max(found_in(depth, near, depth_st, uv), 1e-4), 0.0, 1.0);
    float4 air = fog.SampleLevel(smooth, float3(uv, away), 0);
    return float4(found_in(source, near, source_st, uv).rgb * air.a + air.rgb, 1.0);
}
