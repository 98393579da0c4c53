// The farthest depth of nine texels, for a level of half the size.
#include "include/part.hlsl"

Texture2D<float> source;
[[spv::format_r32f]] [[vk::image_format("r32f")]] RWTexture2D<float> target;

[numthreads(8, 8, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint2 extent, size;
    target.GetDimensions(extent.x, extent.y);
    if (any(int2(id.xy) >= part_extent(int2(extent), target_st))) { return; }
    source.GetDimensions(size.x, size.y);
    int2 last = part_extent(int2(size), source_st) - 1;
    float farthest = 1.0;
    for (int i = 0; i < 9; ++i) { farthest = min(farthest, source.Load(int3(min(int2(id.xy) * 2 + int2(i % 3, i / 3), last), 0))); }
    target[id.xy] = farthest;
}
