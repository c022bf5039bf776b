#version 330 core
// A vertex of a triangle mesh, seen from the light.

layout(location = 0) in vec4 position_m;

uniform mat4 world_to_light;  // to clip coordinates

void main() { gl_Position = world_to_light * vec4(position_m.xyz, 1.0); }
