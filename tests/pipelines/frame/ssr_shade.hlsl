#include "found.hlsl"

Texture2D hits;
Texture2D before;
Texture2D<float2> velocity;
SamplerState near;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float4 hit = found_in(hits, near, hits_st, uv);
    float2 moved = found_in(velocity, near, velocity_st, hit.xy);
    return float4(found_in(before, smooth, before_st, hit.xy + moved).rgb * hit.a, hit.a);
}
