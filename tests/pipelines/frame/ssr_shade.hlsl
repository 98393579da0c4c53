Texture2D hits;
Texture2D before;
Texture2D<float2> velocity;
SamplerState near;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float4 hit = hits.SampleLevel(near, uv, 0);
    float2 moved = velocity.SampleLevel(near, hit.xy, 0);
    return float4(before.SampleLevel(smooth, hit.xy + moved, 0).rgb * hit.a, hit.a);
}
