#include "camera.hlsl"

RWStructuredBuffer<Instance> instances;

[numthreads(64, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint i = id.x, count, stride;
    instances.GetDimensions(count, stride);
    if (i >= count) { return; }
    uint h = i * 2654435761u;
    float3 p = float3(h & 1023u, (h >> 10) & 1023u, (h >> 20) & 1023u) / 1023.0;
    instances[i].sphere = float4((p - float3(0.5, 0.0, 0.5)) * float3(24.0, 3.0, 24.0), 0.06);
    instances[i].color = float4(p, 1.0);
}
