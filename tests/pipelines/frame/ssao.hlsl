#include "found.hlsl"

Texture2D<float> depth;
Texture2D<float2> normal;
Texture2D noise;
SamplerState near;
SamplerState tiled;

float PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float own = found_in(depth, near, depth_st, uv);
    float2 n = found_in(normal, near, normal_st, uv);
    float open = 0.0;
    for (int i = 0; i < 8; ++i) {
        float a = 6.28 * (float(i) / 8.0 + noise.SampleLevel(tiled, uv * 16.0, 0).r);
        open += found_in(depth, near, depth_st, uv + (float2(cos(a), sin(a)) + 0.1 * n) * 0.01) <= own + 1e-4 ? 1.0 : 0.0;
    }
    return open / 8.0;
}
