#include "found.hlsl"

Texture2D now;
Texture2D before;
Texture2D<float2> velocity;
SamplerState near;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    return lerp(found_in(before, smooth, before_st, uv + found_in(velocity, near, velocity_st, uv)), found_in(now, near, now_st, uv), 0.1);
}
