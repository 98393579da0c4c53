#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/scene.glsl"

layout(location = 3) flat in uint object_index;

layout(location = 0) out vec4 color;

void main() {
    color = vec4(objects.object[object_index].emissive, 1.0);
}
