#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/scene.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 3) flat in uint object_index;

layout(location = 0) out vec4 color;

// From where the eye sees which object.
void main() {
    color = vec4(world_position - view.eye_position, float(object_index) + 1.0);
}
