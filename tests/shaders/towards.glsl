#include "include/scene.glsl"

// Where a place in the picture of an eye is seen, as the camera tells it, and the sum of the coordinates of that eye.
vec4 towards(vec2 uv) {
    const vec4 far = view.clip_to_world * vec4(uv * 2.0 - 1.0, 0.5, 1.0);
    return vec4(normalize(far.xyz / far.w - view.eye_position), dot(view.eye_position, vec3(1.0, 10.0, 100.0)));
}
