#version 460
#extension GL_GOOGLE_include_directive : require

#include "include/scale.glsl"
#include "include/temporal.glsl"
#include "include/texture.glsl"

// Radiance of this frame, one sample a texel, shifted from frame to frame by parts of a texel.
layout(set = 0, binding = 0) uniform sampler2D now;
// This shader's previous colour.
layout(set = 0, binding = 1) uniform sampler2D before;
// Depth of this frame, as large as its radiance.
layout(set = 0, binding = 2) uniform sampler2D depth;
// Motion vectors, as `motion` and `motion_sky` draw them: last place minus place. As large.
layout(set = 0, binding = 3) uniform sampler2D motion;
// This shader's previous record; all zero before the first.
layout(set = 0, binding = 4) uniform sampler2D record_before;
layout(set = 0, binding = 5) uniform Params {
    // How much this frame counts at least, more than 0 to 1: less is smoother, and follows changes more slowly.
    float share;
    // How many standard deviations from the 3 × 3 texels around history may be, 0 or more: more is smoother, and leaves longer
    // trails.
    float deviations;
} params;

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;
// How much this frame counted, and the mean change of luma from frame to frame, 0 to 1.
layout(location = 1) out vec2 record;

// Temporal anti-aliasing, as in L. Yang, S. Liu, M. Salvi, "A Survey of Temporal Antialiasing Techniques", Computer Graphics
// Forum 39 (2), 2020: what the frames before showed of the same place is looked up where it was then, by a curve that keeps it
// sharp, as far as the colours around and the changes before allow it. It is where the nearest of those around was, so that edges
// keep theirs. What was outside of the picture, and what was before the first frame, isn't looked up.
void main() {
    const ivec2 extent = used_of(now, now_st);
    const ivec2 at = texel_at(uv, extent);
    vec3 around[9];
    ivec2 nearest = at;
    float nearest_depth = -1.0;
    for (int number = 0; number < 9; ++number) {
        const ivec2 place = clamp(at + ivec2(number % 3, number / 3) - 1, ivec2(0), extent - 1);
        around[number] = guard_radiance(texel_in(now, now_st, place).rgb);
        const float place_depth = guard_alpha(texel_in(depth, depth_st, place).r);
        if (place_depth > nearest_depth) {
            nearest_depth = place_depth;
            nearest = place;
        }
    }
    const vec3 drawn = around[4];
    const vec2 moved = guard_signed(texel_in(motion, motion_st, nearest).rg);
    const vec2 then = uv + moved;
    const bool inside = all(lessThanEqual(abs(then - 0.5), vec2(0.5)));
    const ivec2 extent_before = used_of(record_before, record_before_st);
    const vec2 last = texel_in(record_before, record_before_st, texel_at(clamp(then, 0.0, 1.0), extent_before)).rg;
    const float last_share = guard_alpha(last.r);
    if (!inside || last_share == 0.0) {
        color = vec4(drawn, 1.0);
        record = vec2(1.0, 0.0);
        return;
    }
    const float speed = length(moved * vec2(extent));
    const float share = share_after(last_share, clamp(params.share, 0.0, 1.0), speed);
    const float change = guard_alpha(last.g);
    const vec3 history = guard_color(curve_at(before, before_st, then)).rgb;
    const vec3 allowed = allowed_history(history, around, max(params.deviations, 0.0), change_allowed(change, speed));
    color = vec4(guard_radiance(mixed(drawn, allowed, share)), 1.0);
    record = vec2(share, mix(change, abs(compared(drawn).x - compared(allowed).x), share));
}
