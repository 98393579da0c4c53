// Light that a surface sends to the camera.
#ifndef FRAMEWRIGHT_LIGHTING
#define FRAMEWRIGHT_LIGHTING

#include "include/scene.glsl"

// Share of light that any plain dielectric (refractive index 1.5) mirrors head-on.
const float HEAD_ON_REFLECTANCE = 0.04;
// Blinn-Phong exponent: how tight highlights are.
const float SHININESS = 64.0;
// Below this distance a point light grows no brighter.
const float NEAREST_POINT_LIGHT = 0.01;

// A unit vector along `v`, or zero for a zero vector.
vec3 direction_of(vec3 v) {
    const float squared = dot(v, v);
    return squared > 0.0 ? v * inversesqrt(squared) : vec3(0.0);
}

// Light scattered back by the surface, and light mirrored by it (not coloured by the surface, not dimmed by its alpha).
struct Reflected {
    vec3 diffuse;
    vec3 specular;
};

// Lambert's cosine law (in units in which a white surface facing the light shows `radiance`), and a Blinn-Phong highlight
// normalised by (n + 8) / 8 with Schlick's Fresnel term (T. Akenine-Möller et al., "Real-Time Rendering", 3rd edition,
// section 7.6).
void add_light(inout Reflected reflected, vec3 normal, vec3 to_camera, vec3 to_light, vec3 radiance) {
    const vec3 arriving = radiance * max(dot(normal, to_light), 0.0);
    const vec3 halfway = direction_of(to_light + to_camera);
    const float fresnel =
        HEAD_ON_REFLECTANCE + (1.0 - HEAD_ON_REFLECTANCE) * pow(1.0 - clamp(dot(to_camera, halfway), 0.0, 1.0), 5.0);
    const float highlight = (SHININESS + 8.0) / 8.0 * pow(clamp(dot(normal, halfway), 0.0, 1.0), SHININESS);
    reflected.diffuse += arriving;
    reflected.specular += arriving * fresnel * highlight;
}

// Inverse square, brought to zero at `range` by (1 − (d/range)⁴)² (B. Karis, "Real Shading in Unreal Engine 4", SIGGRAPH
// 2013 course notes, equation 9).
float falloff(float distance_squared, float range) {
    const float share = distance_squared / (range * range);
    const float window = clamp(1.0 - share * share, 0.0, 1.0);
    return window * window / max(distance_squared, NEAREST_POINT_LIGHT * NEAREST_POINT_LIGHT);
}

// Radiance of the sky (above) and the ground (below) in a direction whose share of "up" is `up`, −1…1.
vec3 sky_radiance(float up) {
    const vec3 end = up < 0.0 ? lights.ground_radiance : lights.zenith_radiance;
    return mix(lights.horizon_radiance, end, smoothstep(0.0, 1.0, abs(up)));
}

// What a surface at `position` (world space) reflects. Without ambient light's highlights: the sky is smooth.
Reflected reflect_light(vec3 position, vec3 normal) {
    const vec3 to_camera = direction_of(-position);
    Reflected reflected = Reflected(mix(lights.ground_radiance, lights.zenith_radiance, normal.y * 0.5 + 0.5), vec3(0.0));
    add_light(reflected, normal, to_camera, lights.sun_direction, lights.sun_radiance);
    for (uint i = 0u; i < lights.point_light_count; ++i) {
        const PointLight light = lights.point_lights[i];
        const vec3 towards = light.position - position;
        add_light(reflected, normal, to_camera, direction_of(towards),
                  light.intensity * falloff(dot(towards, towards), light.range));
    }
    return reflected;
}

#endif
