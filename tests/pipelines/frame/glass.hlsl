#include "include/rotation.hlsl"
#include "found.hlsl"
#include "scene.hlsl"

[[vk::binding(0, 2)]] Texture2D base_color_texture;
[[vk::binding(0, 2)]] SamplerState base_color_sampler;
Texture2D behind;
SamplerState smooth;

struct Varyings {
    float4 position : SV_Position;
    [[vk::location(0)]] float3 world_position : WORLD_POSITION;
    [[vk::location(1)]] float3 world_normal : WORLD_NORMAL;
    [[vk::location(2)]] float2 texture_uv : TEXCOORD0;
    [[vk::location(3)]] nointerpolation uint object_index : OBJECT_INDEX;
};

float4 PSMain(Varyings it) : SV_Target0 {
    float4 base = objects[it.object_index].base_color * base_color_texture.Sample(base_color_sampler, it.texture_uv);
    float2 uv = frag_coord(it.position).xy / (2.0 * float2(used_of(behind, behind_st))) + normalize(it.world_normal).xy * 0.03;
    float4 seen = lerp(found_in_level(behind, smooth, behind_st, uv, 1), found_in_level(behind, smooth, behind_st, uv, 2), 0.5);
    return float4(seen.rgb * (1.0 - base.a) + base.rgb * base.a * 0.5, 1.0);
}
