// What deferred lighting keeps of a surface: base colour in 8 bits, the normal in two half floats, emitted light in half
// floats; its place follows from depth. CPU twin: passes/src/twin/g_buffer.rs.
#ifndef FRAMEWRIGHT_G_BUFFER
#define FRAMEWRIGHT_G_BUFFER

// A unit vector as a point of a square from −1 to 1: the octahedron, unfolded (Z. H. Cigolle et al., "A Survey of Efficient
// Representations for Independent Unit Vectors", Journal of Computer Graphics Techniques 3 (2), 2014).
vec2 octahedral(vec3 unit) {
    const vec2 folded = unit.xy / (abs(unit.x) + abs(unit.y) + abs(unit.z));
    const vec2 signs = vec2(folded.x < 0.0 ? -1.0 : 1.0, folded.y < 0.0 ? -1.0 : 1.0);
    return unit.z < 0.0 ? (1.0 - abs(folded.yx)) * signs : folded;
}

// The unit vector of such a point.
vec3 from_octahedral(vec2 point) {
    const vec3 unfolded = vec3(point, 1.0 - abs(point.x) - abs(point.y));
    const float below = max(-unfolded.z, 0.0);
    const vec2 signs = vec2(unfolded.x < 0.0 ? 1.0 : -1.0, unfolded.y < 0.0 ? 1.0 : -1.0);
    return normalize(vec3(unfolded.xy + below * signs, unfolded.z));
}

#endif
