// Stripes by distance from the camera. CPU twin: passes/src/twin/effects.rs.
#ifndef FRAMEWRIGHT_DEPTH_STRIPES
#define FRAMEWRIGHT_DEPTH_STRIPES

// The share of light that a stripe lets through, sin²(π · distance / period): 0 at every whole period, 1 between two. Depth
// is that of distance.glsl's infinite_depth(): near / distance. Where nothing was drawn, and beyond 65,536 periods, where 32
// bits don't tell one from the next, all light passes.
float stripe(float depth, float near, float period) {
    if (!(depth * period * 65536.0 > near)) {
        return 1.0;
    }
    const float wave = sin(3.14159265358979324 * fract(near / (depth * period)));
    return wave * wave;
}

#endif
