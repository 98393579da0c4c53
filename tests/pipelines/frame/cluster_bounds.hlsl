#include "scene.hlsl"

[[vk::constant_id(0)]] const uint ACROSS = 1;
[[vk::constant_id(1)]] const uint DOWN = 1;
RWStructuredBuffer<float4> bounds;

[numthreads(1, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint at = id.x + ACROSS * (id.y + DOWN * id.z);
    float2 low = float2(id.xy) / float2(ACROSS, DOWN) * 2.0 - 1.0;
    float4 nearest = mul(view.sight[eye_index].clip_to_world, float4(low, 0.5, 1.0));
    bounds[2 * at] = nearest;
    bounds[2 * at + 1] = nearest + 1.0;
}
