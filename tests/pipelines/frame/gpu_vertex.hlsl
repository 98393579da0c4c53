#include "scene.hlsl"
#include "camera.hlsl"

StructuredBuffer<Instance> instances;
StructuredBuffer<uint> list;

// A corner of a cube of side 2.
float3 corner_of(uint number) {
    uint face = number / 6;
    float2 corners[6] = { float2(-1, -1), float2(1, -1), float2(-1, 1), float2(-1, 1), float2(1, -1), float2(1, 1) };
    float2 c = corners[number % 6];
    float3 p = float3(c, (face & 1) == 0 ? 1.0 : -1.0);
    return face < 2 ? p : face < 4 ? p.zxy : p.yzx;
}

float4 position_of(Instance it, uint number) {
    return mul(view.sight[eye_index].world_to_clip, float4(it.sphere.xyz - view.sight[eye_index].camera_position + corner_of(number) * it.sphere.w, 1.0));
}
