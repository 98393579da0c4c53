#version 460

layout(location = 0) out vec4 color;

// Each texel's place, and both numbers of it in one.
void main() {
    const vec2 place = floor(gl_FragCoord.xy);
    color = vec4(place, place.x * place.y, 1.0);
}
