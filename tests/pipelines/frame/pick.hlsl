#include "found.hlsl"

Texture2D<uint> ids;
RWStructuredBuffer<uint4> found;
cbuffer PickConstants { int x; int y; };

[numthreads(1, 1, 1)]
void CSMain() {
    found[0] = uint4(ids.Load(int3(min(int2(x, y), used_of(ids, ids_st) - 1), 0)), 0, 0, 0);
}
