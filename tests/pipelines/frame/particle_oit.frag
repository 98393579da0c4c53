#version 460
layout(location = 0) in vec2 across;
layout(location = 0) out vec4 sum;
layout(location = 1) out float revealed;
void main() {
    const float a = 0.3 * max(0.0, 1.0 - length(across));
    const float weight = clamp(gl_FragCoord.z * 100.0, 0.01, 300.0);
    sum = vec4(vec3(1.0, 0.6, 0.2) * a, a) * weight;
    revealed = a;
}
