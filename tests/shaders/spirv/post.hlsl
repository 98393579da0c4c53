// As engines have it: textures and samplers apart, a buffer of constants under a name of its own, registers, several entry points.
Texture2D<float4> source : register(t0, space0);
SamplerState linear_clamp : register(s1, space0);
cbuffer PostConstants : register(b2, space0) { float factor; float3 tint; };

struct Triangle { float4 position : SV_Position; [[vk::location(0)]] float2 uv : TEXCOORD0; };

float3 looked_up(Texture2D<float4> image, SamplerState how, float2 uv) { return image.Sample(how, uv).rgb; }

float4 PSMain(Triangle it) : SV_Target0 { return float4(looked_up(source, linear_clamp, it.uv) * factor * tint, 1.0); }

Triangle VSMain(uint vertex : SV_VertexID) {
    Triangle it;
    it.uv = float2((vertex << 1) & 2, vertex & 2);
    it.position = float4(it.uv * 2.0 - 1.0, 0.0, 1.0);
    return it;
}
