#version 460
layout(set = 0, binding = 0) uniform sampler2D taps[3];
layout(set = 0, binding = 3) uniform Params { int turn; } params;
layout(location = 0) out vec4 color;

void main() {
    // Each pixel takes one of the elements; the loop's number is the same for all pixels.
    int chosen = (int(gl_FragCoord.x) + params.turn) % 3;
    color = vec4(0.0);
    for (int number = 0; number < 3; number++) {
        vec4 found = textureLod(taps[number], vec2(0.5), 0.0);
        if (number == chosen) {
            color = found;
        }
    }
}
