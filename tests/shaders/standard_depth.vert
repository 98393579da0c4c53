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

// As `objects.vert`, with depth that isn't reversed: 0 at the near plane and 1 at the far plane.
void main() {
    const vec4 world = objects.object[gl_InstanceIndex].object_to_world * vec4(position, 1.0);
    const float near = 1e-4;
    const float far = 1e8;
    world_position = world.xyz;
    world_normal = objects.object[gl_InstanceIndex].normal_to_world * normal;
    texture_uv = uv;
    object_index = gl_InstanceIndex;
    vec4 clip = view.world_to_clip * world;
    clip.z = (clip.w - near) * (far / (far - near));
    gl_Position = rotate_clip(clip);
}
