#include "found.hlsl"

Texture2D now;
Texture2D before;
Texture2D<float> depth;
Texture2D<float2> velocity;
SamplerState near;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float2 moved = found_in(velocity, near, velocity_st, uv);
    float4 old = found_in(before, smooth, before_st, uv + moved);
    float4 drawn = found_in(now, smooth, now_st, uv);
    bool outside = any(clamp(uv + moved, 0.0, 1.0) != uv + moved) || found_in(depth, near, depth_st, uv) < 0.0;
    return old.a == 0.0 || outside ? float4(drawn.rgb, 1.0) : float4(lerp(old.rgb, drawn.rgb, 0.1), 1.0);
}
