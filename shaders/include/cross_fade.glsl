// Fading by leaving out fragments in a fixed pattern. CPU twin: passes/src/twin/cross_fade.rs.
#ifndef FRAMEWRIGHT_CROSS_FADE
#define FRAMEWRIGHT_CROSS_FADE

// From which share on a pixel is drawn, 0 to less than 1: the 8 × 8 matrix of B. E. Bayer, "An optimum method for two-level
// rendition of continuous-tone pictures", IEEE International Conference on Communications, 1973, from the bits of both
// coordinates.
float fade_threshold(uvec2 pixel) {
    const uint mixed = pixel.x ^ pixel.y;
    uint order = 0u;
    for (uint bit = 0u; bit < 3u; ++bit) {
        order |= ((mixed >> bit) & 1u) << (5u - 2u * bit);
        order |= ((pixel.y >> bit) & 1u) << (4u - 2u * bit);
    }
    return (float(order) + 0.5) / 64.0;
}

// Whether an object that is seen to this share (−1 to 1) leaves the pixel out. A negative share is seen where the positive
// one isn't.
bool fades_out(float share, vec2 frag_coord) {
    const float threshold = fade_threshold(uvec2(frag_coord));
    return share < 0.0 ? threshold < -share : threshold >= share;
}

#endif
