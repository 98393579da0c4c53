#include "found.hlsl"

Texture2D sum;
Texture2D<float> revealed;
SamplerState near;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float4 s = found_in(sum, near, sum_st, uv);
    float through = found_in(revealed, near, revealed_st, uv);
    return float4(s.rgb / max(s.a, 1e-4) * (1.0 - through), 1.0 - through);
}
