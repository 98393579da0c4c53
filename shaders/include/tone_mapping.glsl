// Tone mapping: radiance in 0…65504 (see radiance.glsl) to 0…1. CPU twin: passes/src/twin/tone_mapping.rs.
#ifndef FRAMEWRIGHT_TONE_MAPPING
#define FRAMEWRIGHT_TONE_MAPPING

#include "include/luminance.glsl"

// What library/tone_mapping.ron calls `clip`, `reinhard`, `white_point`, `filmic`, `neutral` and `reinhard_luminance`.
const int CLIP = 0;
const int REINHARD = 1;
const int WHITE_POINT = 2;
const int FILMIC = 3;
const int NEUTRAL = 4;
const int REINHARD_LUMINANCE = 5;

// c / (1 + c), for each channel by itself: E. Reinhard, M. Stark, P. Shirley, J. Ferwerda, "Photographic Tone Reproduction
// for Digital Images", SIGGRAPH 2002, equation 3.
vec3 reinhard(vec3 radiance) {
    return radiance / (1.0 + radiance);
}

// c / (1 + L) with L the luminance, at most 1: equation 3 of the same, where the luminance becomes L / (1 + L) and the channels
// keep their ratios. A saturated channel may be brighter than white then; it is cut off.
vec3 reinhard_luminance(vec3 radiance) {
    return min(radiance / (1.0 + luminance(radiance)), 1.0);
}

// c · (1 + c/w²) / (1 + c): radiance w becomes 1; equation 4. With w = 1 it is the identity on 0…1; as w grows
// it becomes reinhard(). A white point below 1 counts as 1.
vec3 modified_reinhard(vec3 radiance, float white_point) {
    const float white = max(white_point, 1.0);
    // Divided twice: white² overflows long before white does.
    return min(radiance * (1.0 + radiance / white / white) / (1.0 + radiance), 1.0);
}

// c · (2.51c + 0.03) / (c · (2.43c + 0.59) + 0.14), for each channel by itself: a fit to the film-like curve of ACES by
// K. Narkowicz, "ACES Filmic Tone Mapping Curve", 2016, free to use under CC0 or MIT. Radiance 1 becomes 0.80, 7.2 white.
vec3 filmic(vec3 radiance) {
    return min(radiance * (2.51 * radiance + 0.03) / (radiance * (2.43 * radiance + 0.59) + 0.14), 1.0);
}

// Khronos PBR Neutral: The Khronos Group, "PBR Neutral Specification", 2024, its letters in brackets. Keeps the hue; what is
// not bright is as it was, less what glossy surfaces reflect; what is very bright turns white.
vec3 neutral(vec3 radiance) {
    // Reflected head-on [F90], where compression begins [Ks], and how fast colour is lost [Kd].
    const float reflected = 0.04;
    const float start = 0.8 - reflected;
    const float fading = 0.15;
    const float least = min(radiance.r, min(radiance.g, radiance.b));
    const vec3 base =
        radiance - (least <= 2.0 * reflected ? least - least * least / (4.0 * reflected) : reflected);
    const float peak = max(base.r, max(base.g, base.b));
    if (peak <= start) {
        return max(base, 0.0);
    }
    // The compressed peak [pn], and how much colour is left [g].
    const float compressed = 1.0 - (1.0 - start) * (1.0 - start) / (peak + 1.0 - 2.0 * start);
    const float left = 1.0 / (fading * (peak - compressed) + 1.0);
    return clamp(base * (compressed / peak) * left + compressed * (1.0 - left), 0.0, 1.0);
}

// By one of the operators above; any other number is CLIP. `white_point` matters to WHITE_POINT alone.
vec3 tone_mapped(vec3 radiance, int operator, float white_point) {
    switch (operator) {
        case REINHARD: return reinhard(radiance);
        case WHITE_POINT: return modified_reinhard(radiance, white_point);
        case FILMIC: return filmic(radiance);
        case NEUTRAL: return neutral(radiance);
        case REINHARD_LUMINANCE: return reinhard_luminance(radiance);
        default: return min(radiance, 1.0);
    }
}

#endif
