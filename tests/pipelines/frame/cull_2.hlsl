#include "scene.hlsl"
#include "camera.hlsl"
#include "cull.hlsl"

Texture2D<float> hzb_left;
Texture2D<float> hzb_right;
StructuredBuffer<Instance> instances;
RWStructuredBuffer<uint> list;
RWStructuredBuffer<uint> args;
StructuredBuffer<uint> rest;
StructuredBuffer<uint> rest_count;

[numthreads(64, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint i = id.x;
    if (i == 0) { args[0] = 36; }
    if (i >= rest_count[0]) { return; }
    float4 sphere = instances[rest[i]].sphere;
    if (may_be_seen(view.sight[eye_index].world_to_clip, view.sight[eye_index].camera_position, sphere, hzb_left, hzb_left_st) || may_be_seen(view.sight[eye_index].world_to_clip, view.sight[eye_index].camera_position, sphere, hzb_right, hzb_right_st)) {
        uint slot;
        InterlockedAdd(args[1], 1, slot);
        list[slot] = rest[i];
    }
}
