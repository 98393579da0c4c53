#include "found.hlsl"

Texture2D<float> source;
Texture2D<float> half_depth;
Texture2D<float> depth;
SamplerState near;

float PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float own = found_in(depth, near, depth_st, uv);
    float other = found_in(half_depth, near, half_depth_st, uv);
    return lerp(1.0, found_in(source, near, source_st, uv), exp(-50.0 * abs(own - other)));
}
