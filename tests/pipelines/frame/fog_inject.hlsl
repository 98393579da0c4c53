#include "scene.hlsl"

Texture2DArray<float> shadow;
SamplerState near;
StructuredBuffer<float4> lights_of_engine;
StructuredBuffer<uint2> grid;
StructuredBuffer<uint> items;
[[spv::format_rgba16f]] [[vk::image_format("rgba16f")]] RWTexture3D<float4> target;

[numthreads(4, 4, 4)]
void CSMain(uint3 at : SV_DispatchThreadID) {
    uint3 extent;
    target.GetDimensions(extent.x, extent.y, extent.z);
    if (any(at >= extent)) { return; }
    uint cell = at.x / 5 + 16 * (at.y / 5 + 9 * (at.z * 24 / 64));
    float dark = shadow.SampleLevel(near, float3(float2(at.xy) / float2(80, 45), 0), 0);
    float3 sum = lights[0].sun_radiance * dark * 1e-6 + 0.01;
    uint2 range = grid[cell];
    for (uint i = 0; i < range.y; ++i) { sum += lights_of_engine[2 * items[range.x + i] + 1].rgb; }
    target[at] = float4(sum, 0.02);
}
