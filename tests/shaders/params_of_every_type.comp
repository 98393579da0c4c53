#version 460

layout(local_size_x = 1) in;

layout(set = 0, binding = 0) writeonly buffer Values { float value[]; } values;
layout(set = 0, binding = 1) uniform Params {
    vec3 tint;
    float strength;
    bool on;
    ivec2 cell;
    uvec3 counts;
    bvec2 sides;
    vec4 wide;
    mat2 turn;
    mat3x2 slant;
    layout(row_major) mat2x4 rows;
    mat4 whole;
    int last;
} params;

int at = 0;

void put(float value) { values.value[at++] = value; }

void main() {
    for (int i = 0; i < 3; ++i) put(params.tint[i]);
    put(params.strength);
    put(float(params.on));
    for (int i = 0; i < 2; ++i) put(float(params.cell[i]));
    for (int i = 0; i < 3; ++i) put(float(params.counts[i]));
    for (int i = 0; i < 2; ++i) put(float(params.sides[i]));
    for (int i = 0; i < 4; ++i) put(params.wide[i]);
    for (int column = 0; column < 2; ++column) for (int i = 0; i < 2; ++i) put(params.turn[column][i]);
    for (int column = 0; column < 3; ++column) for (int i = 0; i < 2; ++i) put(params.slant[column][i]);
    for (int column = 0; column < 2; ++column) for (int i = 0; i < 4; ++i) put(params.rows[column][i]);
    for (int column = 0; column < 4; ++column) for (int i = 0; i < 4; ++i) put(params.whole[column][i]);
    put(float(params.last));
}
