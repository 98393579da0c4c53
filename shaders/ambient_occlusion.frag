#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/ambient_occlusion.glsl"
#include "include/distance.glsl"
#include "include/g_buffer.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// Depth of surfaces, of the size that is drawn.
layout(set = 0, binding = 0) uniform sampler2D depth;
// Their normals, as `g_buffer` draws them.
layout(set = 0, binding = 1) uniform sampler2D normal;
layout(set = 0, binding = 2) uniform Params {
    // How far surfaces keep light from each other, metres, more than 0.
    float radius;
    // How much of it they keep away: 0 is none, 1 what surfaces of middling roughness do.
    float strength;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// The place that a texel shows, from the camera on.
vec3 place_at(ivec2 texel, ivec2 extent, float depth_there) {
    const vec2 clip = (vec2(texel) + 0.5) / vec2(extent) * 2.0 - 1.0;
    const vec4 place = view.clip_to_world * vec4(clip, depth_there, 1.0);
    return place.xyz / place.w;
}

// The share of light from everywhere that reaches each surface past those around it; 1 is unoccluded. The pattern varies in
// 4 × 4 texels; blur it with `ambient_occlusion_blur`.
void main() {
    const ivec2 extent = used_of(depth, depth_st);
    const ivec2 texel = texel_at(uv, extent);
    const float depth_here = guard_alpha(texel_in(depth, depth_st, texel).r);
    color = vec4(1.0);
    if (depth_here <= 0.0) {
        return;
    }
    const vec3 here = place_at(texel, extent, depth_here);
    const vec3 facing = from_octahedral(guard_signed(texel_in(normal, normal_st, texel).xy));
    const float away = near_distance() / infinite_depth(depth_here);
    const mat3 rows = transpose(mat3(view.world_to_clip));
    // The radius in texels, seen straight on.
    const vec2 reach = params.radius / away * 0.5 * vec2(length(rows[0]), length(rows[1])) * vec2(extent);
    float sum = 0.0;
    for (int i = 0; i < OCCLUDERS; ++i) {
        const vec2 place = spiral_place(i, spiral_turn(texel));
        const vec2 beside = vec2(cos(place.y), sin(place.y)) * place.x * reach;
        const ivec2 there = ivec2(floor(vec2(texel) + 0.5 + clamp(beside, vec2(-1e6), vec2(1e6))));
        if (all(greaterThanEqual(there, ivec2(0))) && all(lessThan(there, extent))) {
            const float depth_there = guard_alpha(texel_in(depth, depth_st, there).r);
            if (depth_there > 0.0) {
                sum += occlusion_by(place_at(there, extent, depth_there) - here, facing, away, params.radius);
            }
        }
    }
    color = guard_color(vec4(vec3(openness(sum, params.strength)), 1.0));
}
