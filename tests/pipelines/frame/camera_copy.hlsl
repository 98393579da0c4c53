#include "scene.hlsl"
#include "camera.hlsl"

RWStructuredBuffer<CameraData> camera;

[numthreads(1, 1, 1)]
void CSMain() { camera[0].world_to_clip = view.sight[eye_index].world_to_clip; }
