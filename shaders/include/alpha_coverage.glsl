// Edges of masked materials, for alpha that says how many samples of a pixel are covered. CPU twin:
// passes/src/twin/alpha_coverage.rs.
//
// B. Golus, "Anti-aliased Alpha Test: The Esoteric Alpha To Coverage", 2017.
#ifndef FRAMEWRIGHT_ALPHA_COVERAGE
#define FRAMEWRIGHT_ALPHA_COVERAGE

// How much of a pixel is covered, 0 to 1: one half where alpha is the cutoff, and from nothing to all within one pixel. `width`
// is by how much alpha changes from pixel to pixel.
float covered_by(float alpha, float cutoff, float width) {
    return clamp((alpha - cutoff) / max(width, 1e-4) + 0.5, 0.0, 1.0);
}

#endif
