#version 330 core
// A dot for each particle, as wide as the particle at its distance, but never too small to see.

layout(location = 0) in vec4 position_m;        // xyz; w is not used
layout(location = 1) in vec4 velocity_m_per_s;  // xyz; w is not used

uniform mat4 view;
uniform mat4 projection;
uniform float radius_m;
uniform float pixels_per_rad;

flat out float speed_m_per_s;

//! [points]
void main() {
    gl_Position = projection * view * vec4(position_m.xyz, 1.0);
    gl_PointSize = max(1.5, 2.0 * radius_m * pixels_per_rad / gl_Position.w);
    speed_m_per_s = length(velocity_m_per_s.xyz);
}
//! [points]
