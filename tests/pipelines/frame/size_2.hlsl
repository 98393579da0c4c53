StructuredBuffer<uint> rest_count;
RWStructuredBuffer<uint4> groups;

[numthreads(1, 1, 1)]
void CSMain() { groups[0] = uint4((rest_count[0] + 63) / 64, 1, 1, 0); }
