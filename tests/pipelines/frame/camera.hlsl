// The camera for what draws with buffers of its own, as `camera_copy.hlsl` writes it.
struct CameraData {
    float4x4 world_to_clip;
    float4x4 clip_to_world;
    float4x4 before;
    float4 place;
};

struct Instance {
    float4 sphere;
    float4 color;
};
