// Light that a surface sends to the camera.
#ifndef FRAMEWRIGHT_LIGHTING
#define FRAMEWRIGHT_LIGHTING

#include "include/point_lights.glsl"
#include "include/scene.glsl"

// Share of light that any plain dielectric (refractive index 1.5) mirrors head-on.
const float HEAD_ON_REFLECTANCE = 0.04;
// Blinn-Phong exponent: how tight highlights are.
const float SHININESS = 64.0;

// A unit vector along `v`, or zero for a zero vector.
vec3 direction_of(vec3 v) {
    const float squared = dot(v, v);
    return squared > 0.0 ? v * inversesqrt(squared) : vec3(0.0);
}

// Blinn-Phong highlight, normalised by (n + 8) / 8, with Schlick's Fresnel term (T. Akenine-Möller et al., "Real-Time
// Rendering", 3rd edition, section 7.6): the share of arriving light that is mirrored.
float highlight(vec3 normal, vec3 to_camera, vec3 to_light) {
    const vec3 halfway = direction_of(to_light + to_camera);
    const float grazing = pow(1.0 - clamp(dot(to_camera, halfway), 0.0, 1.0), 5.0);
    const float tightness = (SHININESS + 8.0) / 8.0 * pow(clamp(dot(normal, halfway), 0.0, 1.0), SHININESS);
    return mix(HEAD_ON_REFLECTANCE, 1.0, grazing) * tightness;
}

// The share of a point light's intensity that arrives: 1/d², brought to zero at its range by 1 − (d/range)⁴ (glTF
// extension KHR_lights_punctual, "Range Property"). Nearer than `nearest` it grows no brighter.
float falloff(float distance_squared, float inverse_range, float nearest) {
    const float squared = max(distance_squared, nearest * nearest);
    const float share = squared * inverse_range * inverse_range;
    return clamp(1.0 - share * share, 0.0, 1.0) / squared;
}

// What a white surface at `position` scatters of a point light.
vec3 from_point(PointLight light, vec3 position, vec3 normal) {
    const vec3 towards = light.position - position;
    const float facing = max(dot(normal, direction_of(towards)), 0.0);
    return light.intensity * (facing * falloff(dot(towards, towards), light.inverse_range, lights.nearest_to_light));
}

// Light scattered back by a white surface, and light mirrored by any surface.
struct Reflected {
    vec3 diffuse;
    vec3 specular;
};

// What a surface at `position` (world space) reflects: ambient light and Lambert's cosine law, in units in which a white
// surface that faces a light shows its radiance. Only the sun is mirrored, of which the share `sunlit` arrives; of ambient
// light arrives the share `open`.
Reflected reflect_light(vec3 position, vec3 normal, float sunlit, float open) {
    const vec3 from_sun = lights.sun_radiance * (sunlit * max(dot(normal, lights.sun_direction), 0.0));
    vec3 diffuse = lights.ambient_radiance * open + from_sun;
    const Reach reach = reach_of(position);
    for (uint i = 0u; i < reach.count; ++i) {
        diffuse += from_point(light_of(reach, i), position, normal);
    }
    return Reflected(diffuse, from_sun * highlight(normal, direction_of(view.eye_position - position), lights.sun_direction));
}

// Radiance of the sky towards a unit vector, without the sun.
vec3 sky_radiance(vec3 towards) {
    return towards.y < 0.0 ? mix(lights.horizon_radiance, lights.ground_radiance, sqrt(-towards.y))
                           : mix(lights.horizon_radiance, lights.zenith_radiance, towards.y);
}

#endif
