#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/motion.glsl"
#include "include/rotation.glsl"

layout(location = 0) in vec3 position;
layout(location = 2) in vec2 uv;

layout(location = 0) out vec3 now;
layout(location = 1) out vec3 before;
layout(location = 2) out vec2 texture_uv;
layout(location = 3) flat out uint object_index;

// The depth of the pass that drew the same objects must be met, bit by bit.
invariant gl_Position;

// Where the vertices of masked objects are and were.
void main() {
    const vec4 world = objects.object[gl_InstanceIndex].object_to_world * vec4(position, 1.0);
    now = clip_of(motion.world_to_clip[eye_index], objects.object[gl_InstanceIndex].object_to_world, position);
    before = clip_of(motion.previous_world_to_clip[eye_index], motion.previous_object_to_world[gl_InstanceIndex], position);
    texture_uv = uv;
    object_index = gl_InstanceIndex;
    gl_Position = rotate_clip(view.world_to_clip * world);
}
