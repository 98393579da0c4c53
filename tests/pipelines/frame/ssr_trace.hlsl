#include "found.hlsl"
#include "scene.hlsl"

Texture2D<float> depth;
Texture2D<float2> normal;
Texture2D<float> hzb;
SamplerState near;
[[spv::format_rgba16f]] [[vk::image_format("rgba16f")]] RWTexture2D<float4> hits;

[numthreads(8, 8, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint2 texels;
    hits.GetDimensions(texels.x, texels.y);
    int2 extent = part_extent(int2(texels), hits_st);
    if (any(int2(id.xy) >= extent)) { return; }
    float2 uv = (float2(id.xy) + 0.5) / float2(extent);
    float d = found_in(depth, near, depth_st, uv);
    float2 n = found_in(normal, near, normal_st, uv);
    float4 world = mul(view.sight[eye_index].clip_to_world, float4(uv * 2.0 - 1.0, d, 1.0));
    float blocker = found_in_level(hzb, near, hzb_st, uv + 0.05 * n, 2);
    hits[id.xy] = float4(uv + 0.05 * n, blocker, d > 0.0 ? world.w * 1e-6 + 0.2 : 0.0);
}
