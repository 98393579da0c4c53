// Resolves in which bright samples weigh less. CPU twin: passes/src/twin/weighted_resolve.rs.
//
// Tone mapping by 1 / (1 + max) and its inverse: T. Lottes, "Optimized Reversible Tonemapper for Resolve", GPUOpen 2016; as
// weights: B. Karis, "Tone mapping", graphicrants.blogspot.com 2013.
#ifndef FRAMEWRIGHT_WEIGHTED_RESOLVE
#define FRAMEWRIGHT_WEIGHTED_RESOLVE

// What tone mapping multiplies a sample by: radiance in 0…65504 times it is less than 1.
float resolve_weight(vec3 radiance) {
    return 1.0 / (1.0 + max(radiance.r, max(radiance.g, radiance.b)));
}

#endif
