// Where the camera was in the frame before, as `camera_copy.hlsl` keeps it, and what the GPU culls and draws by itself.
struct CameraData {
    float4x4 world_to_clip;
};

struct Instance {
    float4 sphere;
    float4 color;
};
