#version 460
#extension GL_GOOGLE_include_directive : require

#include "towards.glsl"

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Fog that is thicker low down, in the light of the sun.
void main() {
    const vec4 seen = towards(uv);
    color = vec4(lights.sun_radiance * clamp(0.5 - seen.y, 0.0, 1.0), 1.0);
}
