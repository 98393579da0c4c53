RWStructuredBuffer<uint> clock;
RWStructuredBuffer<uint4> once;
cbuffer TickConstants { uint instances; };

[numthreads(1, 1, 1)]
void CSMain() {
    uint first = clock[0] == 0 ? 1 : 0;
    once[0] = uint4((instances + 63) / 64, 1, 1, 0) * first;
    once[1] = uint4(32, 8, 1, 0) * first;
    once[2] = uint4(8, 8, 1, 0) * first;
    once[3] = uint4(0, 0, 0, 0);
    clock[0] += 1;
    clock[1] = 0;
    clock[2] = 0;
    clock[3] = 0;
}
