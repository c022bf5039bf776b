#version 330 core
// A light line with soft rims.

uniform float strength;

in float off_axis;

out vec4 colour;  // linear light and opacity

void main() { colour = vec4(0.85, 0.92, 1.0, strength * smoothstep(1.0, 0.3, abs(off_axis))); }
