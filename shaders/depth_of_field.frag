#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/depth_of_field.glsl"
#include "include/distance.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// Light.
layout(set = 0, binding = 0) uniform sampler2D source;
// The depth of what it shows, of the same size.
layout(set = 0, binding = 1) uniform sampler2D depth;
layout(set = 0, binding = 2) uniform Params {
    // The distance that is sharp, metres along the camera's axis, more than 0.
    float focus;
    // The radius of the disc as which a point infinitely far away is seen, as a share of the picture's height.
    float spread;
    // The largest radius in texels: so far around itself each texel looks.
    int largest;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// 1 / distance; 0 of what is infinitely far, such as the sky.
float nearness_at(ivec2 texel) {
    return infinite_depth(guard_alpha(texel_in(depth, depth_st, texel).r)) / near_distance();
}

// The mean of all light that the lens spreads to a texel. What lies behind the texel's own surface spreads no further than that
// surface does: nothing behind bleeds over an edge that is sharp.
void main() {
    const ivec2 extent = used_of(source, source_st);
    const ivec2 texel = texel_at(uv, extent);
    const float spread = params.spread * float(extent.y);
    const float largest = float(params.largest);
    const float nearness = nearness_at(texel);
    const float radius = disc_radius(nearness, params.focus, spread, largest);
    vec3 sum = vec3(0.0);
    float shares = 0.0;
    for (int y = -params.largest; y <= params.largest; ++y) {
        for (int x = -params.largest; x <= params.largest; ++x) {
            const ivec2 there = texel + ivec2(x, y);
            if (any(lessThan(there, ivec2(0))) || any(greaterThanEqual(there, extent))) {
                continue;
            }
            const float nearness_there = nearness_at(there);
            const float own = disc_radius(nearness_there, params.focus, spread, largest);
            const float share = disc_share(nearness_there < nearness ? min(own, radius) : own, length(vec2(x, y)));
            if (share > 0.0) {
                sum += share * guard_radiance(texel_in(source, source_st, there).rgb);
                shares += share;
            }
        }
    }
    color = vec4(guard_radiance(sum / shares), 1.0);
}
