#include "particle.hlsl"

StructuredBuffer<Particle> state;
RWStructuredBuffer<uint> alive;
RWStructuredBuffer<uint> args;
cbuffer GatherConstants { uint count; };

[numthreads(64, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint i = id.x;
    if (i == 0) { args[0] = 6; }
    if (i < count && state[i].place.w > 0.0) {
        uint slot;
        InterlockedAdd(args[1], 1, slot);
        alive[slot] = i;
    }
}
