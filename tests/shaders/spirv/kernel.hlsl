// The twin of kernel.frag.
struct Light {
    float3 color;
    float gains[2];
};

Texture2D<float4> source : register(t0);
cbuffer Kernel : register(b1) {
    float weights[5];
    float2 offsets[5];
    float2x2 turns[2];
    Light light;
};

float4 PSMain(float4 position : SV_Position) : SV_Target0 {
    float3 sum = float3(0.0, 0.0, 0.0);
    for (int tap = 0; tap < 5; tap++) {
        int2 place = int2(position.xy) + int2(mul(turns[tap & 1], offsets[tap]));
        sum += weights[tap] * source.Load(int3(clamp(place, int2(0, 0), int2(7, 7)), 0)).rgb;
    }
    return float4(sum * light.color, light.gains[0] + 16.0 * light.gains[1]);
}
