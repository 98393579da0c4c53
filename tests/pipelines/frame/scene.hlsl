// What the shipped draw source binds: the twin of include/scene.glsl, as far as this frame reads it. HLSL has no block that ends with an
// array of any length, so the beginning of one is the first element of a buffer.
struct Sight {
    float4x4 world_to_clip;
    float4x4 clip_to_world;
    float3 camera_position;
    float pad_0;
    float3 eye_position;
    float pad_1;
};

struct LightsOfScene {
    float3 sun_direction;
    uint point_light_count;
    float3 sun_radiance;
    float pad_0;
    float3 ambient_radiance;
    float nearest_to_light;
};

struct Object {
    float4x4 object_to_world;
    float4 normal_to_world[3];
    float4 base_color;
    float3 emissive;
    float alpha_cutoff;
    uint transparent;
    float cross_fade;
    float2 pad;
};

struct Cascade {
    float4x4 world_to_clip;
    float texel;
};

struct ViewData { Sight sight[2]; };
struct CascadesData { Cascade cascade[4]; uint count; float reach; };

#include "include/stereo.hlsl"

[[vk::binding(0, 1)]] ConstantBuffer<ViewData> view;
[[vk::binding(1, 1)]] StructuredBuffer<LightsOfScene> lights;
[[vk::binding(2, 1)]] StructuredBuffer<Object> objects;
[[vk::binding(3, 1)]] ConstantBuffer<CascadesData> cascades;
