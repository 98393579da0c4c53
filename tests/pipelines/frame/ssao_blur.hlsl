Texture2D<float> source;
Texture2D<float> depth;
SamplerState smooth;
SamplerState near;
cbuffer BlurConstants { int2 axis; };

float PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float sum = 0.0, weights = 0.0;
    float2 extent;
    source.GetDimensions(extent.x, extent.y);
    float2 texel = 1.0 / extent;
    float own = depth.SampleLevel(near, uv, 0);
    for (int i = -2; i <= 2; ++i) {
        float2 at = uv + float2(axis) * texel * float(i);
        float weight = exp(-100.0 * abs(depth.SampleLevel(near, at, 0) - own));
        sum += weight * source.SampleLevel(smooth, at, 0);
        weights += weight;
    }
    return sum / weights;
}
