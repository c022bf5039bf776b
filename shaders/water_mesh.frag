#version 330 core
// The nearest surface of the mesh at a pixel.

in vec3 place_m;
in vec3 outward;

uniform vec3 eye_m;

layout(location = 0) out vec4 surface;  // normal in world coordinates, distance from the eye in m

void main() { surface = vec4(normalize(outward), distance(place_m, eye_m)); }
