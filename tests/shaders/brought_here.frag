#version 460

layout(location = 0) out vec4 color;

// What `brought_here.vert` brings into the picture.
void main() {
    color = vec4(1.0);
}
