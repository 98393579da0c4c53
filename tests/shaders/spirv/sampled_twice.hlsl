Texture2D<float4> light : register(t0);
Texture2D<float> shadow : register(t1);
Texture2D<float4> noise : register(t2);
SamplerState same : register(s3);
SamplerComparisonState compared : register(s4);

float4 main([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    return (light.Sample(same, uv) + noise.Sample(same, uv)) * shadow.SampleCmpLevelZero(compared, uv, 0.5);
}
