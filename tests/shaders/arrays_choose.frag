#version 460
layout(set = 0, binding = 0) uniform sampler2D taps[3];
layout(set = 0, binding = 3) uniform Params { int turn; } params;
layout(location = 0) out vec4 color;

void main() {
    // Not every device takes a number that changes for the number of an element.
    vec4[3] found = vec4[](
        textureLod(taps[0], vec2(0.5), 0.0), textureLod(taps[1], vec2(0.5), 0.0), textureLod(taps[2], vec2(0.5), 0.0)
    );
    color = found[(int(gl_FragCoord.x) + params.turn) % 3];
}
