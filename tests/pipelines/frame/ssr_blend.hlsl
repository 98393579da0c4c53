Texture2D now;
Texture2D before;
Texture2D<float2> velocity;
SamplerState near;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    return lerp(before.SampleLevel(smooth, uv + velocity.SampleLevel(near, uv, 0), 0), now.SampleLevel(near, uv, 0), 0.1);
}
