#version 460
layout(location = 0) in vec3 tint;
layout(location = 1) in vec3 local;
layout(location = 0) out vec4 base_color;
layout(location = 1) out vec2 normal;
layout(location = 2) out vec4 emissive;
void main() { base_color = vec4(tint, 1.0); normal = normalize(local).xy; emissive = vec4(0.0, 0.0, 0.0, 1.0); }
