// The depth that a place of the picture is compared with.
float depth_at(vec2 uv) {
    return mix(0.0, 0.04, fract(uv.x * 3.0 + uv.y));
}
