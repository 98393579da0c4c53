#include "gpu_vertex.hlsl"

precise float4 VSMain(uint number : SV_VertexID, uint instance : SV_InstanceID) : SV_Position {
    return position_of(instances[list[instance]], number);
}

void PSMain() {}
