Texture2D source;
SamplerState near;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 { return source.SampleLevel(near, uv, 0); }
