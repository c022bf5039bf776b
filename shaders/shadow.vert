#version 330 core
// A sphere seen from the light, which is so far away that the sphere is a circle: one point of its width.

layout(location = 0) in vec4 position_m;

uniform mat4 world_to_light;  // to clip coordinates
uniform float diameter_px;

void main() {
    gl_Position = world_to_light * vec4(position_m.xyz, 1.0);
    gl_PointSize = diameter_px;
}
