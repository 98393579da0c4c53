#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/alpha_coverage.glsl"
#include "include/ambient_occlusion.glsl"
#include "include/cross_fade.glsl"
#include "include/depth_stripes.glsl"
#include "include/distance.glsl"
#include "include/film_grain.glsl"
#include "include/g_buffer.glsl"
#include "include/hdr10.glsl"
#include "include/lighting.glsl"
#include "include/luminance.glsl"
#include "include/motion.glsl"
#include "include/overlay.glsl"
#include "include/radiance.glsl"
#include "include/scale.glsl"
#include "include/sun_shadow.glsl"
#include "include/temporal.glsl"
#include "include/tone_mapping.glsl"

layout(set = 0, binding = 0) uniform Params {
    // Which formula.
    int formula;
} params;

layout(location = 0) out vec4 color;

// Numbers that a program has too, bit by bit: of texel number `at` of 256 × 256 the random number `which` of 64.
uint at;

uint bits(uint which) {
    return hash(at * 64u + which);
}

// 0 to 1, in steps of 2⁻²⁴. A product, which is exact on every driver; a quotient need not be.
float even(uint which) {
    return float(bits(which) >> 8) * (1.0 / 16777216.0);
}

// As many numbers from each power of two to the next: from 2 to the power of `least` on, below 2 to the power of `beyond`.
float wide(uint which, int least, int beyond) {
    return ldexp(1.0 + even(which), least + int(bits(which + 32u) % uint(beyond - least)));
}

vec3 wide3(uint which, int least, int beyond) {
    return vec3(wide(which, least, beyond), wide(which + 1u, least, beyond), wide(which + 2u, least, beyond));
}

vec3 even3(uint which) {
    return vec3(even(which), even(which + 1u), even(which + 2u));
}

// A direction: rounded as a shader's own are.
vec3 unit(uint which) {
    return direction_of(2.0 * even3(which) - 1.0);
}

// A part of an image: at random, of full width, or all of it.
vec4 part(uint which) {
    const vec2 size = vec2(at % 8u < 2u ? 1.0 : 0.0625 + 0.875 * even(which), at % 8u == 0u ? 1.0 : 0.0625 + 0.875 * even(which + 1u));
    return vec4(size, (1.0 - size) * vec2(even(which + 2u), even(which + 3u)));
}

vec4 result(int formula) {
    switch (formula) {
        case 0: return vec4(reinhard(wide3(0u, -24, 16)), 0.0);
        case 1: return vec4(modified_reinhard(wide3(0u, -24, 16), wide(3u, 0, 100)), 0.0);
        case 2: return vec4(filmic(wide3(0u, -24, 16)), 0.0);
        case 3: return vec4(neutral(wide3(0u, -24, 16)), 0.0);
        case 4: return vec4(encode_pq(even(0u)), encode_pq(wide(1u, -60, 0)), 0.0, 0.0);
        case 5: return vec4(encode_hdr10(wide3(0u, -24, 16), 203.0), 0.0);
        case 6: return vec4(luminance(wide3(0u, -24, 16)));
        case 7: return vec4(float(bin_of(wide(0u, -30, 16))), stop_of(uint(at & 255u)), 0.0, 0.0);
        case 8: return vec4(covered_by(even(0u), even(1u), even(2u)));
        case 9: return vec4(fade_threshold(uvec2(at & 255u, at >> 8)), fades_out(2.0 * even(0u) - 1.0, vec2(at & 255u, at >> 8)), 0.0, 0.0);
        case 10: return vec4(even3(0u), grain(uvec2(at & 255u, at >> 8), 7u));
        case 11: return vec4(stripe(0.1 / wide(0u, -4, 4), 0.1, 1.0), stripe(0.1 / wide(1u, 4, 15), 0.1, 1.0), 0.0, 0.0);
        case 12: return vec4(octahedral(unit(0u)), 0.0, 0.0);
        case 13: return vec4(from_octahedral(octahedral(unit(0u))), 0.0);
        case 14: return vec4(highlight(unit(0u), unit(3u), unit(6u)));
        case 15: return vec4(falloff(wide(0u, -20, 20), 0.0, 0.01), falloff(wide(1u, -20, 0), 1.0, 0.01), 0.0, 0.0);
        case 16: return vec4(motion_between(vec3(2.0 * even3(0u).xy - 1.0, 1.0 + even(2u)), vec3(2.0 * even3(3u).xy - 1.0, 1.0 + even(5u))),
                             0.0, 0.0);
        case 17: return vec4(shade_of_distance(wide(0u, -20, 0), 0.1, 20.0), shade_of_signed(2.0 * even3(1u) - 1.0, 1.0));
        case 18: return vec4(near_distance(), infinite_depth(wide(0u, -20, 0)), 0.0, 0.0);
        case 19: return vec4(wide3(0u, -24, 16) * resolve_weight(wide3(0u, -24, 16)), 0.0);
        case 20: return vec4(mixed(wide3(0u, -24, 16), wide3(3u, -24, 16), even(6u)), 0.0);
        case 21: return vec4(catmull_rom(4.0 * even(0u) - 2.0));
        case 22: return vec4(occlusion_by(even3(0u), unit(3u), 1.0, 1.0), openness(even(6u), 1.0), spiral_turn(ivec2(at & 255u, at >> 8)),
                             0.0);
        case 23: return vec4(guard_radiance(uintBitsToFloat(bits(0u))), guard_signed(uintBitsToFloat(bits(1u))),
                             guard_alpha(uintBitsToFloat(bits(2u))), 0.0);
        case 24: {
            const vec4 part = vec4(0.5, 1.0, 0.5, 0.0);
            const float w = 1.0 + 3.0 * even(2u);
            const vec3 seen = non_stereo_screen_pos(vec4(2.0 * even(0u) - 1.0, 2.0 * even(1u) - 1.0, 0.0, w));
            const vec2 packed = uv_adjust(seen.xy, part, w) / seen.z;
            return vec4(uv_adjust(vec2(even(0u), even(1u)), part), packed);
        }
        case 25: {
            vec3 around[9];
            for (uint number = 0u; number < 9u; ++number) {
                around[number] = even3(3u * number);
            }
            return vec4(allowed_history(even3(27u), around, 1.0, 0.25 * even(30u)), 0.0);
        }
        case 26: return vec4(change_allowed(even(0u), 0.5 * even(1u)), share_after(0.01 + even(2u), 0.25 * even(3u), 2.0 * even(4u)), 0.0, 0.0);
        case 27: return vec4(reinhard_luminance(wide3(0u, -24, 16)), 0.0);
        case 28: return vec4(shown(to_ycocg(65504.0 / 65505.0 * even3(0u))), 0.0);
        case 29: return vec4(faded(even(0u), 0.8 + 0.25 * even(1u)), 0.0, 0.0, 0.0);
        case 30: return uv_clamp(vec4(even3(4u), even(7u)), part(0u), ivec2(1u + bits(8u) % 4096u, 1u + bits(9u) % 64u));
        case 31: return uv_adjust(vec4(even3(4u), even(7u)), part(0u));
        case 32: return vec4(uv_unadjust(vec2(even(4u), even(5u)), part(0u)), 0.0, 0.0);
        default: return vec4(0.0);
    }
}

void main() {
    const uvec2 texel = uvec2(gl_FragCoord.xy);
    at = texel.y * 256u + texel.x;
    color = result(params.formula);
}
