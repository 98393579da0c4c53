#version 460
layout(local_size_x = 4, local_size_y = 4) in;
layout(set = 0, binding = 0) uniform params {
    uint number;
    uint read0_parts;
    uint grid_x;
    uint grid_y;
    uint grid_z;
    uint store0_value_mask;
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

layout(set = 0, binding = 1) uniform usampler2D read0;
layout(set = 0, binding = 2, r32ui) uniform writeonly uimage3D store0;
void main() {
    const uvec3 at = gl_GlobalInvocationID, grid = uvec3(grid_x, grid_y, grid_z);
    if (any(greaterThanEqual(at, grid))) return;
    uvec3 place, size;
    int level;
    const uint line = (at.z * grid.y + at.y) * grid.x + at.x;
    const uvec3 here = uvec3(at.x, at.yz);
    uint state = hash(hash(hash(number, here.x), here.y), here.z);
    level = int((here.x / 2u + here.y / 2u + here.z) % uint(textureQueryLevels(read0)));
    size = level_of(uvec3(textureSize(read0, 0), 1u), level, false);
    place = near(size, state, here);
    state = hash4(state, texelFetch(read0, ivec2(place.xy), level), read0_parts);
    place = at;
    if (all(lessThan(at, uvec3(imageSize(store0))))) {
        uvec4 store0_value;
    store0_value = (hashes(state, 64u) & store0_value_mask);
        imageStore(store0, ivec3(place), store0_value);
    }
}
