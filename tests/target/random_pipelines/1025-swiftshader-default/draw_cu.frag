#version 460
layout(set = 0, binding = 0) uniform params {
    uint number;
    uint color0_mask;
};
uint hash(uint state, uint word) {
    state = (state ^ word) * 0x9E3779B1u;
    return state ^ (state >> 15);
}

uint hash4(uint state, uvec4 words, uint parts) {
    state = hash(state, words.x);
    return parts == 1u ? state : hash(hash(hash(state, words.y), words.z), words.w);
}

uvec4 hashes(uint state, uint from) {
    return uvec4(hash(state, from), hash(state, from + 1u), hash(state, from + 2u), hash(state, from + 3u));
}
uvec3 near(uvec3 size, uint state, uvec3 at) {
    return (at + uvec3(state & 3u, (state >> 2) & 3u, (state >> 4) & 3u)) % size;
}

uvec3 level_of(uvec3 size, int level, bool deep) {
    return uvec3(max(size.xy >> level, uvec2(1u)), deep ? max(size.z >> level, 1u) : size.z);
}

vec3 towards(uvec3 place, int size) {
    const vec2 on = (vec2(place.xy) + 0.5) / float(size) * 2.0 - 1.0;
    switch (place.z) {
        case 0: return vec3(1.0, -on.y, -on.x);
        case 1: return vec3(-1.0, -on.y, on.x);
        case 2: return vec3(on.x, 1.0, on.y);
        case 3: return vec3(on.x, -1.0, -on.y);
        case 4: return vec3(on.x, -on.y, 1.0);
        default: return vec3(-on.x, -on.y, -1.0);
    }
}

layout(location = 0) out uvec4 color0;
void main() {
    const uvec3 at = uvec3(gl_FragCoord.xy, 0.0), here = at;
    uvec3 place, size;
    int level;
    uint state = hash(hash(hash(number, at.x), at.y), at.z);
    
    color0 = (hashes(state, 0u) & color0_mask);
}
