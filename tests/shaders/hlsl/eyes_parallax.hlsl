// The twin of eyes_parallax.frag.
#include "include/stereo.hlsl"

struct Sight {
    float4x4 world_to_clip;
    float4x4 clip_to_world;
    float3 camera_position;
    float pad_0;
    float3 eye_position;
    float pad_1;
};
struct ViewData { Sight sight[2]; };
[[vk::binding(0, 1)]] ConstantBuffer<ViewData> view;

float4 PSMain([[vk::location(0)]] float3 world_position : WORLD_POSITION,
    [[vk::location(3)]] nointerpolation uint object_index : OBJECT_INDEX) : SV_Target0 {
    return float4(world_position - view.sight[eye_index].eye_position, float(object_index) + 1.0);
}
