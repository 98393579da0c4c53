// Whether a fragment of a target of 64 × 48 lies off both diagonals. A driver that clips cuts a triangle that covers all along
// one of them, and then both parts cover samples of the texels there.
bool off_the_diagonals() {
    const ivec2 twice = 2 * ivec2(gl_FragCoord.xy) + 1;
    return abs(3 * twice.x - 4 * twice.y) > 7 && abs(3 * twice.x + 4 * twice.y - 384) > 7;
}
