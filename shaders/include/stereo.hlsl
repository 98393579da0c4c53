// Two eyes, in HLSL and Slang: the twin of stereo.glsl.
#ifndef FRAMEWRIGHT_STEREO
#define FRAMEWRIGHT_STEREO

// It stands for the eye where both are drawn for at once. No pipeline sets it: the eye takes its place.
#if defined(FRAMEWRIGHT_BOTH_EYES) && !defined(FRAMEWRIGHT_EYE)
#define FRAMEWRIGHT_EYE
[[vk::constant_id(103)]] const int framewright_eye = 0;
#endif

// Which eye is drawn for: 0 the left one, 1 the right one; 0 where there is one, or both see the same.
#ifdef FRAMEWRIGHT_BOTH_EYES
#define eye_index framewright_eye
#elif !defined(eye_index)
#define eye_index 0
#endif

// Where the picture of the eye that is drawn for lies in what is drawn into: its width and height as shares, and where it begins.
#ifdef FRAMEWRIGHT_HALVES
#define scale_offset float4(0.5, 1.0, 0.5 * float(eye_index), 0.0)
#else
#define scale_offset float4(1.0, 1.0, 0.0, 0.0)
#endif

// A place in the eye's picture, 0 to 1 from its upper left corner, as a place in what is drawn into.
float2 screen_uv(float2 uv) {
    return uv * scale_offset.xy + scale_offset.zw;
}

// Where a position in clip space, before it is rotated, is seen in the eye's own picture, and w, by which x and y are to be
// divided in the fragment shader.
float3 non_stereo_screen_pos(float4 clip) {
    return float3(0.5 * (clip.xy + clip.w), clip.w);
}

// The same in what is drawn into.
float3 screen_pos(float4 clip) {
    float3 place = non_stereo_screen_pos(clip);
    return float3(place.xy * scale_offset.xy + scale_offset.zw * clip.w, clip.w);
}

#endif
