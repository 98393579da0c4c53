// As eyes_told.hlsl, told of the eye by the index of a view.
#include "include/rotation.hlsl"

struct Varyings {
    float4 position : SV_Position;
    [[vk::location(0)]] float2 uv : TEXCOORD0;
    [[vk::location(1)]] nointerpolation int2 told : TOLD;
};

Varyings VSMain(uint vertex : SV_VertexID, uint instance : SV_InstanceID, uint view : SV_ViewID) {
    uint corner = vertex < 3 ? vertex : 6 - vertex == 3 ? 2 : 6 - vertex == 2 ? 1 : 3;
    Varyings it;
    it.uv = (float2(corner & 1, corner >> 1) + float2(instance & 1, instance >> 1)) * 0.5;
    it.told = int2(view, instance);
    it.position = rotate_clip(float4(it.uv * 2.0 - 1.0, 0.0, 1.0));
    return it;
}

float4 PSMain(Varyings it, uint view : SV_ViewID) : SV_Target0 { return float4(float2(it.told), view, 0.25); }
