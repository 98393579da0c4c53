[[vk::constant_id(0)]] const uint ACROSS = 1;
[[vk::constant_id(1)]] const uint DOWN = 1;
[[vk::constant_id(2)]] const uint LIGHTS = 1;
StructuredBuffer<float4> bounds;
StructuredBuffer<float4> lights;
RWStructuredBuffer<uint> used;
RWStructuredBuffer<uint2> grid;
RWStructuredBuffer<uint> items;

[numthreads(1, 1, 1)]
void CSMain(uint3 id : SV_DispatchThreadID) {
    uint at = id.x + ACROSS * (id.y + DOWN * id.z);
    uint found = 0;
    for (uint i = 0; i < LIGHTS; ++i) {
        float4 light = lights[2 * i];
        found += light.w > 0.0 && distance(light.xyz, bounds[2 * at].xyz) < light.w ? 1 : 0;
    }
    uint first;
    InterlockedAdd(used[0], found, first);
    grid[at] = uint2(first, found);
    uint count, stride;
    items.GetDimensions(count, stride);
    for (uint n = 0; n < found && first + n < count; ++n) { items[first + n] = n; }
}
