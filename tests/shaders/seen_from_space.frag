#version 460

layout(location = 0) in vec3 ray;
layout(location = 1) flat in float eye;

layout(location = 0) out vec4 color;

void main() {
    color = vec4(normalize(ray), eye);
}
