#version 460
#extension GL_GOOGLE_include_directive : require
#include "include/texture.glsl"
#include "include/scene.glsl"
layout(set = 0, binding = 0) uniform sampler2D albedo;
layout(set = 0, binding = 1) uniform sampler2D normal;
layout(set = 0, binding = 2) uniform sampler2D emissive;
layout(set = 0, binding = 3) uniform sampler2D depth;
layout(set = 0, binding = 4) uniform sampler2D ao;
layout(set = 0, binding = 5) uniform sampler2D reflection;
layout(set = 0, binding = 6) uniform sampler2DArrayShadow shadow;
layout(set = 0, binding = 7, std430) readonly buffer EngineLights { vec4 light[]; } lights_of_engine;
layout(set = 0, binding = 8, std430) readonly buffer Grid { uvec2 range[]; } grid;
layout(set = 0, binding = 9, std430) readonly buffer Items { uint number[]; } items;
layout(location = 0) in vec2 uv;
layout(location = 0) out vec4 color;
void main() {
    const float d = found_in(depth, depth_st, uv).r;
    const vec4 world = view.clip_to_world * vec4(uv * 2.0 - 1.0, d, 1.0);
    float lit = 0.0;
    const vec3 place = world.xyz / max(world.w, 1e-9);
    for (uint i = 0u; i < min(cascades.count, 4u); ++i) {
        const vec4 in_map = cascades.cascade[i].world_to_clip * vec4(place, 1.0);
        if (all(lessThan(abs(in_map.xy), vec2(0.99)))) { lit = texture(shadow, vec4(in_map.xy * 0.5 + 0.5, float(i), in_map.z + 2e-3)); break; }
    }
    vec3 sum = lights.sun_radiance * lit * 0.6 + lights.ambient_radiance * found_in(ao, ao_st, uv).r;
    const uvec2 range = grid.range[uint(uv.x * 15.99) + 16u * (uint(uv.y * 8.99))];
    for (uint i = 0u; i < range.y; ++i) { sum += lights_of_engine.light[2u * items.number[range.x + i] + 1u].rgb; }
    color = vec4(found_in(albedo, albedo_st, uv).rgb * sum + found_in(emissive, emissive_st, uv).rgb
        + found_in(reflection, reflection_st, uv).rgb + 1e-6 * found_in(normal, normal_st, uv).rgg, 1.0);
}
