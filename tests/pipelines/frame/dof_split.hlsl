Texture2D source;
Texture2D<float> coc;
SamplerState smooth;

struct Targets {
    float4 near : SV_Target0;
    float4 far : SV_Target1;
};

Targets PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) {
    float3 c = source.SampleLevel(smooth, uv, 0).rgb;
    float r = coc.SampleLevel(smooth, uv, 0);
    Targets targets;
    targets.near = float4(c, max(-r, 0.0));
    targets.far = float4(c, max(r, 0.0));
    return targets;
}
