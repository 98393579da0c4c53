#include "scene.hlsl"
#include "camera.hlsl"

RWStructuredBuffer<CameraData> camera;
StructuredBuffer<CameraData> before;

[numthreads(1, 1, 1)]
void CSMain() {
    camera[0].world_to_clip = view.sight[eye_index].world_to_clip;
    camera[0].clip_to_world = view.sight[eye_index].clip_to_world;
    camera[0].before = before[0].world_to_clip;
    camera[0].place = float4(view.sight[eye_index].camera_position, 0.0);
}
