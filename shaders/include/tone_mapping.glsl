// Tone mapping: radiance in 0…65504 (see radiance.glsl) to 0…1. CPU twin: passes/src/twin/tone_mapping.rs.
//
// Source of both curves: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda, "Photographic Tone Reproduction for Digital
// Images", SIGGRAPH 2002, equations 3 and 4, here applied to each channel by itself.
#ifndef FRAMEWRIGHT_TONE_MAPPING
#define FRAMEWRIGHT_TONE_MAPPING

// c / (1 + c)
vec3 reinhard(vec3 radiance) {
    return radiance / (1.0 + radiance);
}

// c · (1 + c/w²) / (1 + c): radiance w becomes 1. With w = 1 it is the identity on 0…1; as w grows it becomes reinhard().
// A white point below 1 counts as 1.
vec3 modified_reinhard(vec3 radiance, float white_point) {
    const float white = max(white_point, 1.0);
    // Divided twice: white² overflows long before white does.
    return min(radiance * (1.0 + radiance / white / white) / (1.0 + radiance), 1.0);
}

#endif
