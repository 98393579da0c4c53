#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/scene.glsl"

layout(location = 0) in vec3 position;
layout(location = 1) in vec3 normal;
layout(location = 2) in vec2 uv;

layout(location = 0) out vec3 world_position;
layout(location = 1) out vec3 world_normal;
layout(location = 2) out vec2 texture_uv;
layout(location = 3) flat out uint object_index;

// A depth-only pass over the same objects must meet the same depth, bit by bit.
invariant gl_Position;

void main() {
    const Object object = objects.object[gl_InstanceIndex];
    const vec4 world = object.object_to_world * vec4(position, 1.0);
    world_position = world.xyz;
    world_normal = object.normal_to_world * normal;
    texture_uv = uv;
    object_index = gl_InstanceIndex;
    gl_Position = rotate_clip(view.world_to_clip * world);
}
