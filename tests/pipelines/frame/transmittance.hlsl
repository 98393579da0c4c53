[[spv::format_rgba16f]] [[vk::image_format("rgba16f")]] RWTexture2D<float4> target;

[numthreads(8, 8, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint2 extent;
    target.GetDimensions(extent.x, extent.y);
    if (any(id.xy >= extent)) { return; }
    target[id.xy] = float4(float2(id.xy) / float2(extent), 0.5, 1.0);
}
