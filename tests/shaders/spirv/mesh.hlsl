// Vertices of a draw source, which each compiler names in its own way.
struct Vertex {
    float given : GIVEN;
    float2 place : PLACE;
};

struct Corner {
    float4 position : SV_Position;
    nointerpolation uint value : VALUE;
};

Corner VSMain(Vertex vertex) {
    Corner corner;
    corner.position = float4(vertex.place, 0.0, 1.0);
    corner.value = uint(vertex.given);
    return corner;
}
