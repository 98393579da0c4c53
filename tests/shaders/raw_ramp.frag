#version 460

layout(location = 0) in vec2 uv;

layout(location = 0) out vec4 color;

// As `ramp`, by what a rotation changes.
void main() {
    const float ramp = 3.0 * uv.x + 5.0 * uv.y;
    color = vec4(dFdx(ramp), dFdy(ramp), gl_FragCoord.xy);
}
