// How what is seen moved since the frame before. Motion is where something was less where it is, as a share of the picture's
// width and height: add it to a place, 0 to 1 from the upper left corner, and there is where the same thing was seen. By how
// much either frame is shifted (`jitter`) isn't part of it. CPU twin: passes/src/twin/motion.rs.
#ifndef FRAMEWRIGHT_MOTION
#define FRAMEWRIGHT_MOTION

#include "include/radiance.glsl"
#include "include/scene.glsl"

layout(set = 1, binding = 5, std430) readonly buffer Motion {
    // As `view.world_to_clip`, but without shift: of both eyes.
    mat4 world_to_clip[2];
    // The same in the frame before, whose camera was the origin of its world space.
    mat4 previous_world_to_clip[2];
    // By gl_InstanceIndex: object space to the world space of the frame before.
    mat4 previous_object_to_world[];
} motion;

// Stands for what was nowhere in the picture. Whatever lies in the picture is moved by less than 1.
const float NOWHERE = 2.0;

// What stands still is moved by exactly 0. Without `precise` a compiler may fuse a product and a sum, and need not do so now and
// then alike: each of both places would be rounded in its own way. That is why `gl_Position`, which other shaders must meet bit by
// bit, has no part in these sums.

// Where a vertex is in clip space: x, y and w.
vec3 clip_of(mat4 world_to_clip, mat4 object_to_world, vec3 position) {
    precise vec4 world = object_to_world * vec4(position, 1.0);
    precise vec4 clip = world_to_clip * world;
    return clip.xyw;
}

// The same of what is infinitely far away in a direction of the world.
vec3 clip_towards(mat4 world_to_clip, vec3 direction) {
    precise vec4 clip = world_to_clip * vec4(direction, 0.0);
    return clip.xyw;
}

// From clip space (x, y and w) now and then.
vec2 motion_between(vec3 now, vec3 before) {
    if (before.z <= 0.0) {
        return vec2(NOWHERE);
    }
    precise vec2 there = before.xy / before.z;
    precise vec2 here = now.xy / now.z;
    // Half, since clip space is two wide and two high.
    precise vec2 moved = 0.5 * (there - here);
    return clamp(guard_signed(moved), -NOWHERE, NOWHERE);
}

#endif
