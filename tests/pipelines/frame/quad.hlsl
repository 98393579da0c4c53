#include "include/rotation.hlsl"

Texture2D source;
SamplerState smooth;

struct Varyings {
    float4 position : SV_Position;
    [[vk::location(0)]] float2 uv : TEXCOORD0;
};

Varyings VSMain(uint number : SV_VertexID) {
    float2 corners[6] = { float2(0, 0), float2(1, 0), float2(0, 1), float2(0, 1), float2(1, 0), float2(1, 1) };
    Varyings it;
    it.uv = corners[number % 6];
    it.position = rotate_clip(float4(it.uv * 0.4 + 0.55, 0.0, 1.0));
    return it;
}

float4 PSMain(Varyings it) : SV_Target0 { return float4(source.SampleLevel(smooth, it.uv, 0).rgb, 0.8); }
