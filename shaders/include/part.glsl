// Images of which a pass may see only a part: one whose size changes from frame to frame is made once, for the largest, and
// used from its upper left corner on; of one that holds both eyes' pictures side by side each eye sees its half. NAME_st stands
// for the part of the image that the pass samples as NAME: how wide and high it is, as shares of the image, and where it begins.
// Where all of the image is seen that is a constant, and nothing is left of these functions.
#ifndef FRAMEWRIGHT_PART
#define FRAMEWRIGHT_PART

#ifdef FRAMEWRIGHT_PARTS
layout(push_constant) uniform FramewrightParts {
    vec4 st[FRAMEWRIGHT_PARTS];
} framewright_parts;
#endif

// Whether the part is all of its image. Number by number: not every optimiser works out that two vectors are the same.
bool is_whole(vec4 st) {
    return st.x == 1.0 && st.y == 1.0 && st.z == 0.0 && st.w == 0.0;
}

// A place in the part, 0 to 1 from its upper left corner, as a place in its image.
vec2 uv_adjust(vec2 uv, vec4 st) {
    return uv * st.xy + st.zw;
}

// Two such places.
vec4 uv_adjust(vec4 uvs, vec4 st) {
    return uvs * st.xyxy + st.zwzw;
}

// The same before a division by w.
vec2 uv_adjust(vec2 uv, vec4 st, float w) {
    return uv * st.xy + st.zw * w;
}

// A place in an image as a place in its part, 0 to 1 from the part's upper left corner.
vec2 uv_unadjust(vec2 uv, vec4 st) {
    return (uv - st.zw) / st.xy;
}

// The place within the part that is nearest to a place in the image (or a mip level of it), whose extent is `texels`. It lies no
// further out than the centres of the outermost texels, so that a linear filter mixes in no texel beyond the part. A small margin
// covers rounding, as texels beyond may hold anything. In a part of a single texel it is the
// centre.
vec2 uv_clamp(vec2 uv, vec4 st, ivec2 texels) {
    const vec2 margin = min((0.5 + 1.0 / 512.0) / vec2(texels), 0.5 * st.xy);
    const vec2 within = clamp(uv, st.zw + margin, st.zw + st.xy - margin);
    // No texel lies beyond the part along an axis that is seen whole.
    return is_whole(st) ? uv : vec2(st.x == 1.0 ? uv.x : within.x, st.y == 1.0 ? uv.y : within.y);
}

// Two such places.
vec4 uv_clamp(vec4 uvs, vec4 st, ivec2 texels) {
    return is_whole(st) ? uvs : vec4(uv_clamp(uvs.xy, st, texels), uv_clamp(uvs.zw, st, texels));
}

// The first texel of the part, in an image whose extent is `texels`.
ivec2 part_origin(ivec2 texels, vec4 st) {
    return is_whole(st) ? ivec2(0) : ivec2(round(vec2(texels) * st.zw));
}

// The extent of the part in texels, in an image whose extent is `texels`.
ivec2 part_extent(ivec2 texels, vec4 st) {
    return is_whole(st) ? texels : ivec2(round(vec2(texels) * st.xy));
}

#endif
