Texture2D<uint> ids;
RWStructuredBuffer<uint4> found;
cbuffer PickConstants { int x; int y; };

[numthreads(1, 1, 1)]
void CSMain() {
    uint2 extent;
    ids.GetDimensions(extent.x, extent.y);
    found[0] = uint4(ids.Load(int3(min(int2(x, y), int2(extent) - 1), 0)), 0, 0, 0);
}
