#include "found.hlsl"
#include "scene.hlsl"

Texture2D albedo;
Texture2D<float2> normal;
Texture2D emissive;
Texture2D<float> depth;
Texture2D<float> ao;
Texture2D reflection;
Texture2DArray<float> shadow;
SamplerState near;
SamplerState smooth;
SamplerComparisonState lit_by;
StructuredBuffer<float4> lights_of_engine;
StructuredBuffer<uint2> grid;
StructuredBuffer<uint> items;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float d = found_in(depth, near, depth_st, uv);
    float4 world = mul(view.sight[eye_index].clip_to_world, float4(uv * 2.0 - 1.0, d, 1.0));
    float lit = 0.0;
    float3 place = world.xyz / max(world.w, 1e-9);
    for (uint i = 0; i < min(cascades.count, 4u); ++i) {
        float4 in_map = mul(cascades.cascade[i].world_to_clip, float4(place, 1.0));
        if (all(abs(in_map.xy) < 0.99)) {
            lit = shadow.SampleCmpLevelZero(lit_by, float3(in_map.xy * 0.5 + 0.5, float(i)), in_map.z + 2e-3);
            break;
        }
    }
    float3 sum = lights[0].sun_radiance * lit * 0.6 + lights[0].ambient_radiance * found_in(ao, smooth, ao_st, uv);
    uint2 range = grid[uint(uv.x * 15.99) + 16 * uint(uv.y * 8.99)];
    for (uint n = 0; n < range.y; ++n) { sum += lights_of_engine[2 * items[range.x + n] + 1].rgb; }
    return float4(found_in(albedo, near, albedo_st, uv).rgb * sum + found_in(emissive, near, emissive_st, uv).rgb
        + found_in(reflection, smooth, reflection_st, uv).rgb + 1e-6 * found_in(normal, near, normal_st, uv).rgg, 1.0);
}
