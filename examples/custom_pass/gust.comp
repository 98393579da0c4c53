#version 460
layout(local_size_x = 1) in;
layout(set = 1, binding = 0) uniform Camera { vec4 shift; } camera;
layout(set = 0, binding = 0) buffer Wind { vec4 push; } wind;

// The wind blows against the camera.
void main() {
    wind.push.xy -= 0.5 * camera.shift.xy;
}
