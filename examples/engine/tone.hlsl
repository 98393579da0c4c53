// A tone curve, and the engine's sparks over it.

Texture2D<float4> light : register(t0);
SamplerState linear_clamp : register(s0);
// xy: place, 0 to 1 from the upper left; z: radius; w: strength.
StructuredBuffer<float4> sparks : register(t1);
cbuffer Tone : register(b0) { float exposure; float aspect; };

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float3 color = light.Sample(linear_clamp, uv).rgb * exposure;
    for (uint i = 0; i < 64; i++) {
        float2 away = (uv - sparks[i].xy) * float2(aspect, 1.0) / sparks[i].z;
        color += float3(1.0, 0.55, 0.2) * sparks[i].w * exp(-dot(away, away));
    }
    color = color / (1.0 + color);
    return float4(pow(color, 1.0 / 2.2), 1.0);
}
