#version 330 core
// One pixel of a sphere made of triangles. Its normal is mixed from those of the corners, so that it looks rounder
// than it is; its depth is the triangle's.

in vec3 normal;  // camera coordinates
flat in float speed_m_per_s;

layout(location = 0) out vec4 surface;  // normal in camera coordinates, speed in m/s

void main() {
    surface = vec4(normalize(normal), speed_m_per_s);
}
