Texture2D<float> source;
Texture2D<float> half_depth;
Texture2D<float> depth;
SamplerState near;

float PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float own = depth.SampleLevel(near, uv, 0);
    float other = half_depth.SampleLevel(near, uv, 0);
    return lerp(1.0, source.SampleLevel(near, uv, 0), exp(-50.0 * abs(own - other)));
}
