#include "include/rotation.hlsl"
#include "found.hlsl"
#include "scene.hlsl"

Texture2D<float> depth;

struct Varyings {
    float4 position : SV_Position;
    [[vk::location(0)]] nointerpolation float3 center : CENTER;
};

struct Targets {
    float4 albedo : SV_Target0;
    float4 normal : SV_Target1;
};

Varyings VSMain(uint number : SV_VertexID, uint instance : SV_InstanceID) {
    Varyings it;
    it.center = float3(float(instance % 4) * 2.0 - 3.0, 0.0, float(instance / 4) * 2.0 - 1.0) - view.sight[eye_index].camera_position;
    uint face = number / 6;
    float2 corners[6] = { float2(-1, -1), float2(1, -1), float2(-1, 1), float2(-1, 1), float2(1, -1), float2(1, 1) };
    float3 p = float3(corners[number % 6], (face & 1) == 0 ? 1.0 : -1.0);
    it.position = mul(view.sight[eye_index].world_to_clip, float4(it.center + 0.5 * (face < 2 ? p : face < 4 ? p.zxy : p.yzx), 1.0));
    return it;
}

Targets PSMain(Varyings it) {
    float2 place = frag_coord(it.position).xy;
    float d = depth.Load(int3(place, 0));
    float4 world = mul(view.sight[eye_index].clip_to_world, float4(place / float2(used_of(depth, depth_st)) * 2.0 - 1.0, d, 1.0));
    float3 local = world.xyz / world.w - it.center;
    if (any(abs(local) > 0.5)) { discard; }
    Targets targets;
    targets.albedo = float4(0.8, 0.1, 0.05, 0.7);
    targets.normal = float4(0.0, 0.0, 0.0, 0.2);
    return targets;
}
