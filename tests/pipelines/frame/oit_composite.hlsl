Texture2D sum;
Texture2D<float> revealed;
SamplerState near;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float4 s = sum.SampleLevel(near, uv, 0);
    float through = revealed.SampleLevel(near, uv, 0);
    return float4(s.rgb / max(s.a, 1e-4) * (1.0 - through), 1.0 - through);
}
