Texture2D transmittance;
Texture2D multi;
SamplerState smooth;
[[spv::format_rgba16f]] [[vk::image_format("rgba16f")]] RWTexture3D<float4> target;

[numthreads(4, 4, 4)]
void CSMain(uint3 at : SV_DispatchThreadID) {
    uint3 extent;
    target.GetDimensions(extent.x, extent.y, extent.z);
    float3 uv = (float3(at) + 0.5) / float3(extent);
    target[at] = transmittance.SampleLevel(smooth, uv.xz, 0) + multi.SampleLevel(smooth, uv.xy, 0);
}
