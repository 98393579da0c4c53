#include "found.hlsl"

// Whether a sphere may be seen: in the picture, and no farther than the farthest depth of the pyramid around it.
bool may_be_seen(float4x4 world_to_clip, float3 camera, float4 sphere, Texture2D<float> pyramid, float4 part) {
    float4 clip = mul(world_to_clip, float4(sphere.xyz - camera, 1.0));
    if (clip.w < sphere.w || any(abs(clip.xy) > clip.w + 2.0 * sphere.w)) { return false; }
    float2 uv = clip.xy / clip.w * 0.5 + 0.5;
    uint width, height, levels;
    pyramid.GetDimensions(0, width, height, levels);
    float wide = sphere.w / clip.w * float(used_of(pyramid, part).x);
    int level = clamp(int(ceil(log2(max(wide, 1.0)))), 0, int(levels) - 1);
    int2 extent = used_of_level(pyramid, part, level);
    int2 at = clamp(int2(uv * float2(extent)), int2(0, 0), extent - 1);
    float farthest = pyramid.Load(int3(at, level));
    return (clip.z / clip.w) * 1.01 + 1e-4 >= farthest;
}
