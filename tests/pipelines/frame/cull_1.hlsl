#include "scene.hlsl"
#include "camera.hlsl"
#include "cull.hlsl"

Texture2D<float> hzb_left;
Texture2D<float> hzb_right;
ConstantBuffer<CameraData> before;
StructuredBuffer<Instance> instances;
RWStructuredBuffer<uint> list;
RWStructuredBuffer<uint> args;
RWStructuredBuffer<uint> rest;
RWStructuredBuffer<uint> rest_count;
cbuffer CullConstants { uint count; };

[numthreads(64, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint i = id.x;
    if (i == 0) { args[0] = 36; }
    if (i >= count) { return; }
    float4 sphere = instances[i].sphere;
    uint slot;
    if (may_be_seen(before.world_to_clip, view.sight[eye_index].camera_position, sphere, hzb_left, hzb_left_st) || may_be_seen(before.world_to_clip, view.sight[eye_index].camera_position, sphere, hzb_right, hzb_right_st)) {
        InterlockedAdd(args[1], 1, slot);
        list[slot] = i;
    } else {
        InterlockedAdd(rest_count[0], 1, slot);
        rest[slot] = i;
    }
}
