#include "found.hlsl"

Texture2D<float> source;
Texture2D<float> depth;
SamplerState smooth;
SamplerState near;
cbuffer BlurConstants { int2 axis; };

float PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float sum = 0.0, weights = 0.0;
    float2 texel = 1.0 / float2(used_of(source, source_st));
    float own = found_in(depth, near, depth_st, uv);
    for (int i = -2; i <= 2; ++i) {
        float2 at = uv + float2(axis) * texel * float(i);
        float weight = exp(-100.0 * abs(found_in(depth, near, depth_st, at) - own));
        sum += weight * found_in(source, smooth, source_st, at);
        weights += weight;
    }
    return sum / weights;
}
