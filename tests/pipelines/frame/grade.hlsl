struct ExposureData { float scale; };

Texture2D source;
Texture3D table;
SamplerState near;
SamplerState smooth;
ConstantBuffer<ExposureData> exposure;

float4 PSMain([[vk::location(0)]] float2 uv : TEXCOORD0) : SV_Target0 {
    float3 c = source.SampleLevel(near, uv, 0).rgb * max(exposure.scale, 0.05);
    float3 t = c / (1.0 + c);
    float3 side;
    table.GetDimensions(side.x, side.y, side.z);
    return float4(table.SampleLevel(smooth, t * (side - 1.0) / side + 0.5 / side, 0).rgb, 1.0);
}
