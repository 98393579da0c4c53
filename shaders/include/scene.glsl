// What the shipped draw source binds: set 1 for the frame, set 2 for the material. The same table for the CPU:
// passes/src/draw/interface.rs.
//
// World space here has the axes of the scene but its origin at the camera, for both eyes between them: differences to the camera
// are taken on the CPU in 64 bits, so that a scene a million units from its origin doesn't shake.
#ifndef FRAMEWRIGHT_SCENE
#define FRAMEWRIGHT_SCENE

#include "include/stereo.glsl"

struct Object {
    // Object space to world space.
    mat4 object_to_world;
    // Takes normals to world space, up to their length.
    mat3 normal_to_world;
    // Linear colour and alpha by which the texture is multiplied.
    vec4 base_color;
    // Emitted radiance.
    vec3 emissive;
    // Masked materials discard fragments whose alpha is below.
    float alpha_cutoff;
    // 1 if alpha says how much of what is behind stays hidden, 0 if alpha is to be ignored.
    uint transparent;
    // How much of it is seen, −1 to 1; see cross_fade.glsl.
    float cross_fade;
};

struct PointLight {
    // In world space.
    vec3 position;
    // 1 over the distance at which its light has faded to nothing; 0 if it reaches everywhere.
    float inverse_range;
    // Radiance that a white, rough surface facing it shows at distance 1.
    vec3 intensity;
};

// A view of the scene: the camera's, or that of one eye.
struct Sight {
    // Reversed depth: 1 at the near plane, 0 at the far plane, or infinitely far; see distance.glsl.
    mat4 world_to_clip;
    mat4 clip_to_world;
    // Where the camera stands in the scene's own coordinates; where there are two eyes, between them.
    vec3 camera_position;
    // Where the eye is in world space: at the origin, unless there are two.
    vec3 eye_position;
};

layout(set = 1, binding = 0, std140) uniform View {
    // The left eye's and the right one's; the same twice where one looks.
    Sight sight[2];
} view;
// That of the eye that is drawn for: `view.world_to_clip`.
#define view view.sight[eye_index]

layout(set = 1, binding = 1, std430) readonly buffer Lights {
    // Unit vector towards the sun.
    vec3 sun_direction;
    uint point_light_count;
    // Radiance that a white, rough surface facing the sun shows.
    vec3 sun_radiance;
    // Radiance that a white surface shows without any of these lights.
    vec3 ambient_radiance;
    // Nearer than this a surface gets no more of a point light, metres.
    float nearest_to_light;
    // Radiance of the sky straight up, at eye level and straight down.
    vec3 zenith_radiance;
    vec3 horizon_radiance;
    vec3 ground_radiance;
    // How many of the point lights, the first ones, reach everywhere; the others stand in the lists of `clusters`.
    uint lights_everywhere;
    PointLight point_lights[];
} lights;

layout(set = 1, binding = 2, std430) readonly buffer Objects {
    // By gl_InstanceIndex.
    Object object[];
} objects;

// How the sun sees a part of the scene; see include/sun_shadow.glsl.
struct Cascade {
    // Depth is reversed: 1 is nearest to the sun.
    mat4 world_to_clip;
    // Width of a texel of its map, metres.
    float texel;
};

layout(set = 1, binding = 3, std140) uniform Cascades {
    // The nearest first.
    Cascade cascade[4];
    uint count;
    // How far from the camera shadows reach, metres.
    float reach;
} cascades;

// Which of the other point lights reach which part of what the camera sees; see include/point_lights.glsl.
layout(set = 1, binding = 4, std430) readonly buffer Clusters {
    // World space to tiles of the picture, times the distance along the camera's axis, which is w.
    mat4 world_to_cluster;
    uint tiles_across;
    uint tiles_down;
    uint slices;
    // 1 over the distance from which on slices count, metres, and how many there are from there to twice as far.
    float inverse_nearest;
    float slices_per_doubling;
    // For each cluster where its list begins, and where the last one ends; then the lists: numbers of lights.
    uint words[];
} clusters;

#endif
