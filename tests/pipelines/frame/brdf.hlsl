[[spv::format_rg16f]] [[vk::image_format("rg16f")]] RWTexture2D<float2> target;

[numthreads(8, 8, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint2 extent;
    target.GetDimensions(extent.x, extent.y);
    if (any(id.xy >= extent)) { return; }
    target[id.xy] = float2(id.xy) / float2(extent);
}
