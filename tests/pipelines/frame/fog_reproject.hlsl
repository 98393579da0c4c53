Texture3D now;
Texture3D before;
SamplerState smooth;
[[spv::format_rgba16f]] [[vk::image_format("rgba16f")]] RWTexture3D<float4> target;

[numthreads(4, 4, 4)]
void CSMain(uint3 at : SV_DispatchThreadID) {
    uint3 extent;
    target.GetDimensions(extent.x, extent.y, extent.z);
    if (any(at >= extent)) { return; }
    float4 old = before.SampleLevel(smooth, (float3(at) + 0.5) / float3(extent), 0);
    target[at] = lerp(old, now.Load(int4(at, 0)), 0.1);
}
