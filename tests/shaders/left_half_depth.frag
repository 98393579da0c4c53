#version 460

// Nothing but what the rasteriser writes.
void main() {}
