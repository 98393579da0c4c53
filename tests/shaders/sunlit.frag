#version 460
#extension GL_GOOGLE_include_directive : require

#ifdef HAS_sun_shadow
layout(set = 0, binding = 0) uniform TEXTURE_sun_shadow sun_shadow;
layout(set = 0, binding = 8) uniform Params { int shadow_taps; } params;
#endif

#include "include/lighting.glsl"
#include "include/sun_shadow.glsl"

layout(location = 0) in vec3 world_position;
layout(location = 1) in vec3 world_normal;

layout(location = 0) out vec4 place;
layout(location = 1) out vec4 facing;

// Where a surface is, how much of the sun's light arrives there, and where the surface faces.
void main() {
    const vec3 normal = direction_of(gl_FrontFacing ? world_normal : -world_normal);
    place = vec4(world_position, sunlit(world_position, normal));
    facing = vec4(normal, 1.0);
}
