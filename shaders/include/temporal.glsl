// What the frames before have left of a picture, mixed with this one. Radiance is compared as it looks when it is tone-mapped,
// and weighs so: see weighted_resolve.glsl. CPU twin: passes/src/twin/temporal.rs.
#ifndef FRAMEWRIGHT_TEMPORAL
#define FRAMEWRIGHT_TEMPORAL

#include "include/radiance.glsl"
#include "include/weighted_resolve.glsl"

// A deviation that is taken for none: that of one bit of a half float below 1.
const float EVEN_DEVIATION = 1e-3;
// History at rest may differ by this many times the mean change from frame to frame.
const float CHANGES_ALLOWED = 2.0;
// The mean change counts for nothing from this speed on, in texels a frame.
const float SPEED_OF_CHANGE = 0.25;
// The least share of a frame where something moves by a texel a frame or more: history is blurred each time it is looked up.
const float SHARE_IN_MOTION = 0.25;

// Luma and two differences of colour (ITU-T H.273, YCgCo): what is seen as an edge shows in the first.
vec3 to_ycocg(vec3 color) {
    const float green = 0.5 * color.g;
    const float others = 0.25 * (color.r + color.b);
    return vec3(green + others, 0.5 * (color.r - color.b), green - others);
}

vec3 from_ycocg(vec3 color) {
    const float others = color.x - color.z;
    return vec3(others + color.y, color.x + color.z, others - color.y);
}

// 0…65504 to below 1, in luma and differences.
vec3 compared(vec3 radiance) {
    return to_ycocg(radiance * resolve_weight(radiance));
}

// Back to radiance.
vec3 shown(vec3 color) {
    const vec3 small = max(from_ycocg(color), 0.0);
    const float most = max(small.r, max(small.g, small.b));
    return guard_radiance(small / max(1.0 - most, 1.0 / 65505.0));
}

// History, clipped to the colours of the 3 × 3 texels around. Where it is further from their mean than `deviations` standard
// deviations and `allowance`, it is moved nearer along a straight line (M. Salvi, "An Excursion in Temporal Supersampling",
// GDC 2016; the line: L. J. F. Pedersen, "Temporal Reprojection Anti-Aliasing in INSIDE", GDC 2016).
vec3 allowed_history(vec3 history, vec3 around[9], float deviations, float allowance) {
    vec3 mean = vec3(0.0);
    for (int at = 0; at < 9; ++at) {
        mean += compared(around[at]) / 9.0;
    }
    vec3 variance = vec3(0.0);
    for (int at = 0; at < 9; ++at) {
        const vec3 apart = compared(around[at]) - mean;
        variance += apart * apart / 9.0;
    }
    const vec3 reach = deviations * sqrt(variance) + allowance + EVEN_DEVIATION;
    const vec3 apart = compared(history) - mean;
    const vec3 reaches = abs(apart) / reach;
    const float most = max(reaches.x, max(reaches.y, reaches.z));
    return most > 1.0 ? shown(mean + apart / most) : history;
}

// By how much history may differ from all colours around. A bar that is narrower than a texel is missed by some frames; the frames
// before saw it come and go. `change` is their mean change of luma, `speed` in texels a frame.
float change_allowed(float change, float speed) {
    return CHANGES_ALLOWED * change * clamp(1.0 - speed / SPEED_OF_CHANGE, 0.0, 1.0);
}

// How much a frame counts: at first as much as each frame before (their plain mean), at least `share`. `last` is how much the
// frame before counted.
float share_after(float last, float share, float speed) {
    return max(max(share, SHARE_IN_MOTION * clamp(speed, 0.0, 1.0)), last / (1.0 + last));
}

// The mean of what is drawn, which counts `share`, and of history; bright ones weigh less.
vec3 mixed(vec3 drawn, vec3 history, float share) {
    const float of_drawn = share * resolve_weight(drawn);
    const float of_history = (1.0 - share) * resolve_weight(history);
    return (of_drawn * drawn + of_history * history) / (of_drawn + of_history);
}

#endif
