#version 330 core
// All faces of a closed mesh, added up: far ends of stretches of water count plus, near ends minus. No order needed.

in vec3 place_m;

uniform vec3 eye_m;

layout(location = 0) out vec4 thickness_m;

void main() { thickness_m = vec4((gl_FrontFacing ? -1.0 : 1.0) * distance(place_m, eye_m)); }
