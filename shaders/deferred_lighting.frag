#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/g_buffer.glsl"
#include "include/lighting.glsl"
#include "include/radiance.glsl"
#include "include/texture.glsl"

// What `g_buffer` draws first; all four of the size that is drawn, and sampled with `filter: Nearest`.
layout(set = 0, binding = 0) uniform sampler2D base_color;
// What it draws second: octahedral.
layout(set = 0, binding = 1) uniform sampler2D normal;
// What it draws third.
layout(set = 0, binding = 2) uniform sampler2D emissive;
// The depth of the same objects.
layout(set = 0, binding = 3) uniform sampler2D depth;
#ifdef HAS_ambient_occlusion
// The share of ambient light that reaches each surface, as `ambient_occlusion_blur` draws it. It may be left out.
layout(set = 0, binding = 5) uniform sampler2D ambient_occlusion;
#endif
#ifdef HAS_sun_shadow
// Depth of what casts the sun's shadows, one layer for each cascade. It may be left out, and `shadow_taps` with it.
layout(set = 0, binding = 4) uniform TEXTURE_sun_shadow sun_shadow;
layout(set = 0, binding = 8) uniform Params {
    // Width of the filter at the edges of shadows in texels of the map, 1 to 7.
    int shadow_taps;
} params;
#endif

#include "include/sun_shadow.glsl"

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// Lights what a G-buffer holds. Where no object is the result is black: the sky goes there.
void main() {
    const float place = guard_alpha(found_in(depth, depth_st, uv).r);
    if (place <= 0.0) {
        color = vec4(0.0, 0.0, 0.0, 1.0);
        return;
    }
    const vec4 from_camera = view.clip_to_world * vec4(uv * 2.0 - 1.0, place, 1.0);
    const vec3 facing = from_octahedral(guard_signed(found_in(normal, normal_st, uv).xy));
    const vec3 position = from_camera.xyz / from_camera.w;
#ifdef HAS_ambient_occlusion
    const float open = guard_alpha(found_in(ambient_occlusion, ambient_occlusion_st, uv).r);
#else
    const float open = 1.0;
#endif
    const Reflected reflected = reflect_light(position, facing, sunlit(position, facing), open);
    const vec3 scattered = guard_radiance(found_in(base_color, base_color_st, uv).rgb) * reflected.diffuse;
    const vec3 emitted = guard_radiance(found_in(emissive, emissive_st, uv).rgb);
    color = vec4(guard_radiance(scattered + reflected.specular + emitted), 1.0);
}
