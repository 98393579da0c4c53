// Pictures that are drawn turned, as a screen wants them that is mounted so. `uv` of full-screen draws, images that are
// sampled, and all that is not said here are those of the upright picture. Where the target isn't turned the constant is 0, and
// nothing is left of these functions. What stands for it on the CPU: graph/src/vulkan/rotation.rs.
#ifndef FRAMEWRIGHT_ROTATION
#define FRAMEWRIGHT_ROTATION

// By how many quarters the picture is turned, clockwise: 0 to 3.
layout(constant_id = 100) const uint framewright_rotation = 0u;
// Width and height of the turned picture, in texels.
layout(constant_id = 101) const uint framewright_turned_width = 0u;
layout(constant_id = 102) const uint framewright_turned_height = 0u;

// A direction in the upright picture, x to the right and y down, as it is in the turned one.
vec2 rotate_direction(vec2 upright) {
    switch (framewright_rotation) {
        case 1u: return vec2(-upright.y, upright.x);
        case 2u: return -upright;
        case 3u: return vec2(upright.y, -upright.x);
        default: return upright;
    }
}

// A position in clip space for `gl_Position`.
vec4 rotate_clip(vec4 upright) {
    return vec4(rotate_direction(upright.xy), upright.zw);
}

#ifdef FRAMEWRIGHT_FRAGMENT
// `gl_FragCoord` of the upright picture, of two eyes that lie side by side of the picture of the one that is drawn for.
vec4 frag_coord() {
    const vec2 turned = vec2(framewright_turned_width, framewright_turned_height);
    vec4 coord = gl_FragCoord;
#ifdef FRAMEWRIGHT_HALVES
    const vec2 towards = rotate_direction(vec2(framewright_eye == 0 ? -1.0 : 1.0, 0.0));
    coord.xy -= turned * max(towards, vec2(0.0));
#endif
    switch (framewright_rotation) {
        case 1u: return vec4(coord.y, turned.x - coord.x, coord.zw);
        case 2u: return vec4(turned - coord.xy, coord.zw);
        case 3u: return vec4(turned.y - coord.y, coord.x, coord.zw);
        default: return coord;
    }
}

// By how much `value` changes from pixel to pixel to the right, and down, in the upright picture: `dFdx` and `dFdy` of that.
#define FRAMEWRIGHT_DERIVATIVES(TYPE) \
    TYPE ddx(TYPE value) { \
        switch (framewright_rotation) { \
            case 1u: return dFdy(value); \
            case 2u: return -dFdx(value); \
            case 3u: return -dFdy(value); \
            default: return dFdx(value); \
        } \
    } \
    TYPE ddy(TYPE value) { \
        switch (framewright_rotation) { \
            case 1u: return -dFdx(value); \
            case 2u: return -dFdy(value); \
            case 3u: return dFdx(value); \
            default: return dFdy(value); \
        } \
    }
FRAMEWRIGHT_DERIVATIVES(float)
FRAMEWRIGHT_DERIVATIVES(vec2)
FRAMEWRIGHT_DERIVATIVES(vec3)
FRAMEWRIGHT_DERIVATIVES(vec4)
#endif

#endif
