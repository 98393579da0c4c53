#include "scene.hlsl"
#include "particle.hlsl"

StructuredBuffer<Particle> state;
StructuredBuffer<uint> alive;

struct Varyings {
    float4 position : SV_Position;
    [[vk::location(0)]] float2 across : TEXCOORD0;
};

struct Targets {
    float4 sum : SV_Target0;
    float revealed : SV_Target1;
};

Varyings VSMain(uint number : SV_VertexID, uint instance : SV_InstanceID) {
    float2 corners[6] = { float2(-1, -1), float2(1, -1), float2(-1, 1), float2(-1, 1), float2(1, -1), float2(1, 1) };
    Varyings it;
    it.across = corners[number % 6];
    float4 clip = mul(view.sight[eye_index].world_to_clip, float4(state[alive[instance]].place.xyz - view.sight[eye_index].camera_position, 1.0));
    it.position = clip + float4(it.across * float2(0.02, 0.03), 0.0, 0.0);
    return it;
}

Targets PSMain(Varyings it) {
    float a = 0.3 * max(0.0, 1.0 - length(it.across));
    float weight = clamp(it.position.z * 100.0, 0.01, 300.0);
    Targets targets;
    targets.sum = float4(float3(1.0, 0.6, 0.2) * a, a) * weight;
    targets.revealed = a;
    return targets;
}
