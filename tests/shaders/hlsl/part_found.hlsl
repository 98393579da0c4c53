// The twin of part_found.frag.
#include "include/texture.hlsl"

Texture2D<float4> now : register(t0);
Texture2D<float2> before : register(t1);
SamplerState linear_clamp : register(s0);

float4 PSMain(float4 position : SV_Position, [[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float2 sum = found_in(now, linear_clamp, now_st, uv).xy + 0.25 * found_in(before, linear_clamp, before_st, uv);
    int2 used = used_of(before, before_st);
    return float4(sum + 0.5 * texel_in(before, before_st, texel_at(uv, used)), float2(used_of(now, now_st) + 100 * used));
}
