// The twin of eyes_told.vert and eyes_told.frag.
#include "include/rotation.hlsl"
#include "include/stereo.hlsl"

struct Varyings {
    float4 position : SV_Position;
    [[vk::location(0)]] float2 uv : TEXCOORD0;
    [[vk::location(1)]] nointerpolation int2 told : TOLD;
};

struct Targets { float4 eyes : SV_Target0; float4 places : SV_Target1; float4 undivided : SV_Target2; };

// Four instances cover a quarter of the picture each.
Varyings VSMain(uint vertex : SV_VertexID, uint instance : SV_InstanceID) {
    static const uint corners[6] = { 0, 1, 2, 2, 1, 3 };
    uint corner = corners[vertex];
    Varyings it;
    it.uv = (float2(corner & 1, corner >> 1) + float2(instance & 1, instance >> 1)) * 0.5;
    it.told = int2(eye_index, instance);
    it.position = rotate_clip(float4(it.uv * 2.0 - 1.0, 0.0, 1.0));
    return it;
}

Targets PSMain(Varyings it) {
    float4 clip = float4((2.0 * it.uv - 1.0) * (1.0 + it.uv.y), 0.5, 1.0 + it.uv.y);
    Targets found;
    found.eyes = float4(float2(it.told), eye_index, 0.25);
    found.places = float4(screen_uv(it.uv), frag_coord(it.position).xy);
    found.undivided = float4(screen_pos(clip).xy, non_stereo_screen_pos(clip).xy) + scale_offset;
    return found;
}
