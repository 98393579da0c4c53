#ifndef TINT
#define TINT

struct Tint { float3 tint; float strength; float corners; };

float3 tinted(float3 color, float2 uv, float3 tint, float strength, float corners) {
    float3 toned = dot(color, float3(0.2126, 0.7152, 0.0722)) * tint;
    float2 from_centre = uv - 0.5;
    float darker = 1.0 - corners * dot(from_centre, from_centre);
    return lerp(color, toned, strength) * darker;
}

#endif
