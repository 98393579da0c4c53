struct Item { float3 place; float size; };
StructuredBuffer<Item> items : register(t0);
AppendStructuredBuffer<uint> large : register(u1);
cbuffer Cull : register(b2) { uint count; };

[numthreads(64, 1, 1)]
void CSCull(uint3 id : SV_DispatchThreadID) {
    if (id.x < count && items[id.x].size > 0.5) { large.Append(id.x); }
}
