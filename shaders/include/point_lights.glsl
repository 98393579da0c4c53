// The point lights that reach a place. What is seen is cut into clusters by place in the picture and by distance, each with
// the list of lights that reach it (O. Olsson, M. Billeter, U. Assarsson, "Clustered Deferred and Forward Shading", High
// Performance Graphics 2012). The lists are made by passes/src/draw/clusters.rs.
//
//     for (uint i = 0u; i < reach.count; ++i) { … light_of(reach, i) … }
#ifndef FRAMEWRIGHT_POINT_LIGHTS
#define FRAMEWRIGHT_POINT_LIGHTS

#include "include/scene.glsl"

struct Reach {
    // Of the list of the place's cluster, in `clusters.words`.
    uint first;
    // How many lights reach the place, those that reach everywhere among them.
    uint count;
};

// What reaches a place in world space.
Reach reach_of(vec3 position) {
    const vec4 place = clusters.world_to_cluster * vec4(position, 1.0);
    const float along = max(place.w, 1e-30);
    const vec2 tiles = vec2(clusters.tiles_across, clusters.tiles_down);
    // An eye may see what is behind the camera between both: there nothing but the side counts.
    const vec2 at = place.w > 0.0 ? place.xy / along : step(0.5 * tiles * place.w, place.xy) * tiles;
    const uvec2 tile = uvec2(clamp(at, vec2(0.0), tiles - 1.0));
    const float depth = log2(along * clusters.inverse_nearest) * clusters.slices_per_doubling;
    const uint slice = uint(clamp(depth, 0.0, float(clusters.slices) - 1.0));
    const uint cluster = (slice * clusters.tiles_down + tile.y) * clusters.tiles_across + tile.x;
    const uint first = clusters.words[cluster];
    return Reach(first, lights.lights_everywhere + clusters.words[cluster + 1u] - first);
}

// One of them, by its number from 0.
PointLight light_of(Reach reach, uint number) {
    const uint everywhere = lights.lights_everywhere;
    const uint light = number < everywhere ? number : clusters.words[reach.first + number - everywhere];
    return lights.point_lights[light];
}

#endif
