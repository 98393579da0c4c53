Texture2D<float4> source;

float4 kept(float4 color, float least) {
    if (color.a < least) {
        discard;
    }
    return color;
}

float4 PSMain(float4 position : SV_Position) : SV_Target0 { return kept(source.Load(int3(position.xy, 0)), 0.5); }
