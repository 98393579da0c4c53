#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/rotation.glsl"

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// How a ramp changes to the right and down, and where the fragment lies.
void main() {
    const float ramp = 3.0 * uv.x + 5.0 * uv.y;
    color = vec4(ddx(ramp), ddy(ramp), frag_coord().xy);
}
