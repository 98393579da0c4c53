#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/lighting.glsl"
#include "include/radiance.glsl"

layout(location = 0) in vec3 direction;

layout(location = 0) out vec4 color;

// How tight the glow around the sun and the sun's own disc are.
const float GLOW_EXPONENT = 32.0;
const float DISC_EXPONENT = 2048.0;
// How bright they are beside a white surface that faces the sun.
const float GLOW_SHARE = 0.15;
const float DISC_SHARE = 4.0;

// The sky by day, and the sun in it with a glow around.
void main() {
    const vec3 towards = direction_of(direction);
    const float sunward = clamp(dot(towards, lights.sun_direction), 0.0, 1.0);
    // No sun shines from below the horizon.
    const float above = smoothstep(-0.02, 0.02, towards.y);
    const float sun = above * (GLOW_SHARE * pow(sunward, GLOW_EXPONENT) + DISC_SHARE * pow(sunward, DISC_EXPONENT));
    color = vec4(guard_radiance(sky_radiance(towards) + sun * lights.sun_radiance), 1.0);
}
