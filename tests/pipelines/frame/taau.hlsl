Texture2D now;
Texture2D before;
Texture2D<float> depth;
Texture2D<float2> velocity;
SamplerState near;
SamplerState smooth;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float2 moved = velocity.SampleLevel(near, uv, 0);
    float4 old = before.SampleLevel(smooth, uv + moved, 0);
    float4 drawn = now.SampleLevel(smooth, uv, 0);
    bool outside = any(clamp(uv + moved, 0.0, 1.0) != uv + moved) || depth.SampleLevel(near, uv, 0) < 0.0;
    return old.a == 0.0 || outside ? float4(drawn.rgb, 1.0) : float4(lerp(old.rgb, drawn.rgb, 0.1), 1.0);
}
