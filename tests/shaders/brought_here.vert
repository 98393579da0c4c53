#version 460

layout(location = 0) in vec3 position;

// Places every object in the middle of the picture, wherever it stands.
void main() {
    gl_Position = vec4(position.x * 0.5, -position.y * 0.5, 0.5, 1.0);
}
