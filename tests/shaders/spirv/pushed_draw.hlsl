// What a draw brings by push constants: a number, and a place.
struct Brought {
    uint4 number;
    float2 shift;
};

[[vk::push_constant]] ConstantBuffer<Brought> brought;

float4 VSMain(uint vertex : SV_VertexID) : SV_Position {
    return float4(float2(vertex & 1, vertex >> 1) - 1.0 + brought.shift, 0.0, 1.0);
}

uint PSMain() : SV_Target0 {
    return brought.number.x;
}
