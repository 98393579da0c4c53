Texture2D source;
Texture2D<float> coc;
Texture2D near;
Texture2D far;
SamplerState sharp;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float4 n = near.SampleLevel(smooth, uv, 0), f = far.SampleLevel(smooth, uv, 0);
    float3 behind = lerp(source.SampleLevel(sharp, uv, 0).rgb, f.rgb, clamp(coc.SampleLevel(sharp, uv, 0), 0.0, 1.0));
    return float4(lerp(behind, n.rgb, n.a), 1.0);
}
