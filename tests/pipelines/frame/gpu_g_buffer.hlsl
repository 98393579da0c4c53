#include "gpu_vertex.hlsl"

struct Varyings {
    precise float4 position : SV_Position;
    [[vk::location(0)]] float3 tint : TINT;
    [[vk::location(1)]] float3 local : LOCAL;
};

struct Targets {
    float4 base_color : SV_Target0;
    float2 normal : SV_Target1;
    float4 emissive : SV_Target2;
};

Varyings VSMain(uint number : SV_VertexID, uint instance : SV_InstanceID) {
    Instance it = instances[list[instance]];
    Varyings varyings;
    varyings.tint = it.color.rgb;
    varyings.local = corner_of(number);
    varyings.position = position_of(it, number);
    return varyings;
}

Targets PSMain(Varyings it) {
    Targets targets;
    targets.base_color = float4(it.tint, 1.0);
    targets.normal = normalize(it.local).xy;
    targets.emissive = float4(0.0, 0.0, 0.0, 1.0);
    return targets;
}
