Texture2D transmittance;
Texture2D multi;
SamplerState smooth;
[[spv::format_rgba16f]] [[vk::image_format("rgba16f")]] RWTexture2D<float4> target;

[numthreads(8, 8, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint2 extent;
    target.GetDimensions(extent.x, extent.y);
    float2 uv = (float2(id.xy) + 0.5) / float2(extent);
    target[id.xy] = transmittance.SampleLevel(smooth, uv, 0) + multi.SampleLevel(smooth, uv, 0);
}
