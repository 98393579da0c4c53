#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"
#include "include/scene.glsl"
#include "include/stereo.glsl"

layout(location = 0) in vec3 position;

layout(location = 0) out vec3 screen;

// Objects that know where on the screen they are seen.
void main() {
    const vec4 clip = view.world_to_clip * (objects.object[gl_InstanceIndex].object_to_world * vec4(position, 1.0));
    screen = non_stereo_screen_pos(clip);
    gl_Position = rotate_clip(clip);
}
