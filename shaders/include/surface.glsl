// The colour of a lit object.
#ifndef FRAMEWRIGHT_SURFACE
#define FRAMEWRIGHT_SURFACE

#include "include/lighting.glsl"
#include "include/radiance.glsl"
#include "include/sun_shadow.glsl"

// Colour multiplied by its alpha, for `Premultiplied` blending; opaque objects have alpha 1. Highlights and emitted light
// are not dimmed by alpha: glass mirrors no less for being clear.
vec4 lit_surface(uint object_index, vec4 base_color, vec3 position, vec3 normal) {
    const Object object = objects.object[object_index];
    const float alpha = object.transparent != 0u ? clamp(base_color.a, 0.0, 1.0) : 1.0;
    const vec3 facing = direction_of(gl_FrontFacing ? normal : -normal);
    const Reflected reflected = reflect_light(position, facing, sunlit(position, facing), 1.0);
    return guard_color(vec4(base_color.rgb * reflected.diffuse * alpha + reflected.specular + object.emissive, alpha));
}

#endif
