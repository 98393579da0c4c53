// Images of which a frame may use only a part: one whose size changes from frame to frame is made once, for the largest, and
// used from its upper left corner on. NAME_st stands for the part of the image that the pass samples as NAME: how wide and high
// it is, as shares of the image, and where it begins. Where all of the image is used that is a constant, and nothing is left of
// these functions.
#ifndef FRAMEWRIGHT_PART
#define FRAMEWRIGHT_PART

#ifdef FRAMEWRIGHT_PARTS
layout(push_constant) uniform FramewrightParts {
    vec4 st[FRAMEWRIGHT_PARTS];
} framewright_parts;
#endif

// Whether the part is all of its image.
bool is_whole(vec4 st) {
    return st == vec4(1.0, 1.0, 0.0, 0.0);
}

// A place in the part, 0 to 1 from its upper left corner, as a place in its image.
vec2 uv_adjust(vec2 uv, vec4 st) {
    return uv * st.xy + st.zw;
}

// The place of the part, in an image of so many texels, that is nearest to a place in that image: no further out than the middle
// of the outermost texels, so that a linear filter mixes in nothing that lies beyond. A little further in, since the middle is
// met up to rounding only: what lies beyond may be anything, and a trace of it may be too much.
vec2 uv_clamp(vec2 uv, vec4 st, ivec2 texels) {
    const vec2 margin = (0.5 + 1.0 / 512.0) / vec2(texels);
    return is_whole(st) ? uv : clamp(uv, st.zw + margin, st.zw + st.xy - margin);
}

// How many texels wide and high the part is, in an image of so many.
ivec2 part_extent(ivec2 texels, vec4 st) {
    return is_whole(st) ? texels : ivec2(round(vec2(texels) * st.xy));
}

#endif
