#ifndef TINT
#define TINT

struct Tint { float3 tint; float strength; float corners; };

float3 tinted(float3 color, float2 uv, Tint by) {
    float3 toned = dot(color, float3(0.2126, 0.7152, 0.0722)) * by.tint;
    float2 from_centre = uv - 0.5;
    float darker = 1.0 - by.corners * dot(from_centre, from_centre);
    return lerp(color, toned, by.strength) * darker;
}

#endif
