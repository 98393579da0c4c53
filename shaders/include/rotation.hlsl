// Pictures that are drawn turned, as a screen wants them that is mounted so, in HLSL and Slang: the twin of rotation.glsl. Where the
// target isn't turned the constant is 0, and nothing is left of these functions.
#ifndef FRAMEWRIGHT_ROTATION
#define FRAMEWRIGHT_ROTATION

// It stands for the eye where both are drawn for at once: stereo.hlsl.
#if defined(FRAMEWRIGHT_BOTH_EYES) && !defined(FRAMEWRIGHT_EYE)
#define FRAMEWRIGHT_EYE
[[vk::constant_id(103)]] const int framewright_eye = 0;
#endif

// By how many quarters the picture is turned, clockwise: 0 to 3.
[[vk::constant_id(100)]] const uint framewright_rotation = 0;
// Width and height of the turned picture, in texels.
[[vk::constant_id(101)]] const uint framewright_turned_width = 0;
[[vk::constant_id(102)]] const uint framewright_turned_height = 0;

// A direction in the upright picture, x to the right and y down, as it is in the turned one.
float2 rotate_direction(float2 upright) {
    if (framewright_rotation == 1) return float2(-upright.y, upright.x);
    if (framewright_rotation == 2) return -upright;
    if (framewright_rotation == 3) return float2(upright.y, -upright.x);
    return upright;
}

// A position in clip space for `SV_Position`.
float4 rotate_clip(float4 upright) {
    return float4(rotate_direction(upright.xy), upright.zw);
}

// `SV_Position` of a fragment, `coord`, as it is in the upright picture, of two eyes that lie side by side in the picture of the one that is
// drawn for.
float4 frag_coord(float4 coord) {
    float2 turned = float2(framewright_turned_width, framewright_turned_height);
#ifdef FRAMEWRIGHT_HALVES
    float2 towards = rotate_direction(float2(framewright_eye == 0 ? -1.0 : 1.0, 0.0));
    coord.xy -= turned * max(towards, float2(0.0, 0.0));
#endif
    if (framewright_rotation == 1) return float4(coord.y, turned.x - coord.x, coord.zw);
    if (framewright_rotation == 2) return float4(turned - coord.xy, coord.zw);
    if (framewright_rotation == 3) return float4(turned.y - coord.y, coord.x, coord.zw);
    return coord;
}

#endif
