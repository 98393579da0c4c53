// A cube for each object, without vertex buffers; its material is a number in the table of all textures.

struct Object {
    float4x4 to_world;
    uint material;
    uint unused_0, unused_1, unused_2;
};

cbuffer Camera : register(b0, space2) { column_major float4x4 to_clip; };
StructuredBuffer<Object> objects : register(t1, space2);

// The engine's own set.
Texture2D<float4> textures[64] : register(t0, space1);
SamplerState trilinear : register(s1, space1);

struct Corner {
    float4 position : SV_Position;
    float3 normal : NORMAL;
    float2 uv : TEXCOORD0;
    nointerpolation uint material : MATERIAL;
};

static const uint ORDER[6] = { 0, 1, 2, 2, 1, 3 };

Corner VSMain(uint vertex : SV_VertexID, uint number : SV_InstanceID) {
    uint face = vertex / 6;
    uint corner = ORDER[vertex % 6];
    float2 uv = float2(corner & 1, corner >> 1);
    uint axis = face >> 1;
    float side = (face & 1) == 0 ? 1.0 : -1.0;
    float2 across = (uv * 2.0 - 1.0) * float2(side, 1.0);
    float3 place = float3(side, across.x, across.y);
    float3 normal = float3(side, 0.0, 0.0);
    place = axis == 0 ? place : (axis == 1 ? place.zxy : place.yzx);
    normal = axis == 0 ? normal : (axis == 1 ? normal.zxy : normal.yzx);

    Object object = objects[number];
    float4 world = mul(float4(place * 0.5, 1.0), object.to_world);
    Corner result;
    result.position = mul(to_clip, world);
    result.normal = mul(float4(normal, 0.0), object.to_world).xyz;
    result.uv = uv;
    result.material = object.material;
    return result;
}

float4 PSMain(Corner corner) : SV_Target0 {
    // All of a draw has one number, so it needs no NonUniformResourceIndex.
    float3 base = textures[corner.material].Sample(trilinear, corner.uv).rgb;
    float sun = saturate(dot(normalize(corner.normal), normalize(float3(0.4, 0.8, 0.45))));
    return float4(base * (0.15 + sun), 1.0);
}
