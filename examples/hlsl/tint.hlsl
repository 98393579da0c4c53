// A post effect in HLSL: the picture in sepia, with darker corners.
//
//     framewright run examples/hlsl/tint.ron --scene spheres_and_cubes -o tinted.png
//
Texture2D<float4> source : register(t0);
SamplerState linear_clamp : register(s0);

cbuffer Tint : register(b0) {
    float3 tint;
    float strength;
    float corners;
};

float4 PSMain(float2 uv : TEXCOORD0) : SV_Target0 {
    float3 color = source.Sample(linear_clamp, uv).rgb;
    float3 toned = dot(color, float3(0.2126, 0.7152, 0.0722)) * tint;
    float2 from_centre = uv - 0.5;
    float darker = 1.0 - corners * dot(from_centre, from_centre);
    return float4(lerp(color, toned, strength) * darker, 1.0);
}
