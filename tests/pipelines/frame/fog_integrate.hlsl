Texture3D scattered;
[[spv::format_rgba16f]] [[vk::image_format("rgba16f")]] RWTexture3D<float4> target;

[numthreads(8, 8, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint3 extent;
    target.GetDimensions(extent.x, extent.y, extent.z);
    if (any(id.xy >= extent.xy)) { return; }
    float3 sum = 0.0;
    float through = 1.0;
    for (uint z = 0; z < extent.z; ++z) {
        float4 here = scattered.Load(int4(id.xy, z, 0));
        sum += through * here.rgb * (1.0 - exp(-here.a));
        through *= exp(-here.a);
        target[uint3(id.xy, z)] = float4(sum, through);
    }
}
