#include "particle.hlsl"

RWStructuredBuffer<Particle> state;
StructuredBuffer<Particle> before;
cbuffer MoveConstants { uint count; uint frame; float seconds; };

[numthreads(64, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint i = id.x;
    if (i >= count) { return; }
    Particle p = before[i];
    if (p.place.w <= 0.0) {
        uint h = (i + frame * 977u) * 2654435761u;
        p.place = float4(float3(h & 1023u, (h >> 10) & 1023u, (h >> 20) & 1023u) / 1023.0 * float3(8, 4, 8) - float3(4, 0, 4), 1.0);
        p.speed = float4(0.0, 0.3, 0.0, 0.0);
    }
    p.place += float4(p.speed.xyz * seconds, -seconds * 0.2);
    state[i] = p;
}
