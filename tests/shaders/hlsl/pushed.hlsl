// As engines have it: registers of each kind from 0 on, several entry points, push constants.
#include "tint.hlsli"

Texture2D<float4> source : register(t0);
SamplerState linear_clamp : register(s0);
RWStructuredBuffer<uint> counts : register(u0);
[[vk::push_constant]] ConstantBuffer<Tint> constants;

struct Triangle { float4 position : SV_Position; [[vk::location(0)]] float2 uv : TEXCOORD0; };

float4 PSMain(Triangle it) : SV_Target0 {
    float3 color = source.Sample(linear_clamp, it.uv).rgb;
    return float4(tinted(color, it.uv, constants.tint, constants.strength, constants.corners), 1.0);
}

Triangle VSMain(uint vertex : SV_VertexID) {
    Triangle it;
    it.uv = float2((vertex << 1) & 2, vertex & 2);
    it.position = float4(it.uv * 2.0 - 1.0, 0.0, 1.0);
    return it;
}

[numthreads(64, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) { counts[id.x] = id.x * uint(constants.strength); }
