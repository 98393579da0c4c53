// Two eyes. A shader is written for one, and knows nothing else unless it asks here: `view` is that of the eye that is drawn for,
// vertices and fragments lie in its picture, and what each eye has of its own is sampled by `NAME_st` (part.glsl, texture.glsl).
// Where both eyes' pictures don't lie side by side nothing is left of these functions.
#ifndef FRAMEWRIGHT_STEREO
#define FRAMEWRIGHT_STEREO

#include "include/part.glsl"

// Which eye is drawn for: 0 the left one, 1 the right one; 0 where there is one, or both see the same.
#ifdef FRAMEWRIGHT_BOTH_EYES
#define eye_index framewright_eye
#elif !defined(eye_index)
#define eye_index 0
#endif

// Where the picture of the eye that is drawn for lies in what is drawn into: its width and height as shares, and where it begins.
#ifdef FRAMEWRIGHT_HALVES
#define scale_offset vec4(0.5, 1.0, 0.5 * float(eye_index), 0.0)
#else
#define scale_offset vec4(1.0, 1.0, 0.0, 0.0)
#endif

// A place in the eye's picture, 0 to 1 from its upper left corner, as a place in what is drawn into.
vec2 screen_uv(vec2 uv) {
    return uv_adjust(uv, scale_offset);
}

vec4 screen_uv(vec4 uvs) {
    return uv_adjust(uvs, scale_offset);
}

// Where a position in clip space, before it is rotated, is seen in the eye's own picture, and w, by which x and y are to be
// divided in the fragment shader: for what is laid over each eye's picture alike, or is the same for both, as dirt on a lens.
vec3 non_stereo_screen_pos(vec4 clip) {
    return vec3(0.5 * (clip.xy + clip.w), clip.w);
}

// The same in what is drawn into.
vec3 screen_pos(vec4 clip) {
    return vec3(uv_adjust(non_stereo_screen_pos(clip).xy, scale_offset, clip.w), clip.w);
}

#endif
