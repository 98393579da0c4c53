#include "found.hlsl"

Texture2D<float> depth;
SamplerState near;
cbuffer CocConstants { float focus; float spread; };

float PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    return clamp((0.1 / max(found_in(depth, near, depth_st, uv), 1e-4) - focus) * spread, -1.0, 1.0);
}
