#version 460
layout(location = 3) flat in uint object_index;
layout(location = 0) out uint picked;
void main() { picked = object_index + 1u; }
