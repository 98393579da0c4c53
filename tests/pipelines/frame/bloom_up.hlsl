Texture2D source;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 { return source.SampleLevel(smooth, uv, 0) * 0.5; }
