Texture2D near;
Texture2D far;
SamplerState smooth;

struct Targets {
    float4 near_blurred : SV_Target0;
    float4 far_blurred : SV_Target1;
};

Targets PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) {
    Targets targets;
    targets.near_blurred = 0.0;
    targets.far_blurred = 0.0;
    for (int i = 0; i < 8; ++i) {
        float2 o = float2(cos(float(i) * 0.785), sin(float(i) * 0.785)) * 0.004;
        targets.near_blurred += near.SampleLevel(smooth, uv + o, 0) / 8.0;
        targets.far_blurred += far.SampleLevel(smooth, uv + o, 0) / 8.0;
    }
    return targets;
}
