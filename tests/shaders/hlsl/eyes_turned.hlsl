// The twin of eyes_turned.vert and eyes_turned.frag.
#include "include/rotation.hlsl"
#include "include/stereo.hlsl"

struct Varyings {
    float4 position : SV_Position;
    [[vk::location(0)]] nointerpolation int eye : EYE;
};

Varyings VSMain(uint vertex : SV_VertexID, uint instance : SV_InstanceID) {
    static const float2 corners[6] = { float2(0, 0), float2(1, 0), float2(0, 1), float2(0, 1), float2(1, 0), float2(1, 1) };
    float2 corner = corners[vertex];
    Varyings it;
    it.eye = eye_index;
    float2 place = float2(corner.x * 0.5 + float(instance) * 0.875 - 1.25 + 0.25 * float(eye_index), corner.y * 1.5 - 1.0);
    it.position = rotate_clip(float4(place, 0.0, 1.0));
    return it;
}

float4 PSMain(Varyings it) : SV_Target0 {
    return float4(frag_coord(it.position).xy / 128.0, float(eye_index) * 0.5 + 0.25, float(it.eye) * 0.5 + 0.25);
}
