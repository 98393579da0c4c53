#version 460
#extension GL_GOOGLE_include_directive : require

#ifdef HAS_sun_shadow
// Any numbers for depth.
layout(set = 0, binding = 0) uniform TEXTURE_sun_shadow sun_shadow;
layout(set = 0, binding = 8) uniform Params { int shadow_taps; } params;
#endif

#include "include/random.glsl"
#include "include/sun_shadow.glsl"

layout(location = 0) out vec4 color;

// How much the surface rises along rows and columns. Sums of its multiples are exact.
const vec2 SLOPE = vec2(0.0625, -0.125);

// The filter of shadows at random places of a map of 64 × 48: the place, the depth, and what is uncovered.
void main() {
    const uint at = uint(gl_FragCoord.y) * 256u + uint(gl_FragCoord.x);
    const vec2 place = vec2(8.0) + vec2(48.0, 32.0) * vec2(random(3u * at), random(3u * at + 1u));
    const float depth = random(3u * at + 2u);
    color = vec4(0.0);
#ifdef HAS_sun_shadow
    color = vec4(place, depth, uncovered(place, 0, depth, SLOPE, params.shadow_taps));
#endif
}
