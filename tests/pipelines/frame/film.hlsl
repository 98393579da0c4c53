Texture2D source;
Texture2D noise;
SamplerState near;
SamplerState tiled;
cbuffer FilmConstants { float amount; };

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    return float4(source.SampleLevel(near, uv, 0).rgb + (noise.Sample(tiled, uv * 8.0).r - 0.5) * amount, 1.0);
}
