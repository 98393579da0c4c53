#version 460

// Opaque objects, of which only depth is drawn.
void main() {}
