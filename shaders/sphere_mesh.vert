#version 330 core
// A corner of a sphere made of triangles, for comparison with the impostor. `rings` from pole to pole and twice as
// many segments around make 2 rings^2 rectangles of two triangles each; one sphere an instance.

layout(location = 0) in vec4 position_m;        // xyz; w is not used
layout(location = 1) in vec4 velocity_m_per_s;  // xyz; w is not used

uniform mat4 view;
uniform mat4 projection;
uniform float radius_m;
uniform int rings;

out vec3 normal;  // camera coordinates
flat out float speed_m_per_s;

// A rectangle's two triangles. Bit 0 of a corner is the next segment, bit 1 the next ring.
const int kCorner[6] = int[6](0, 1, 2, 2, 1, 3);

//! [mesh]
void main() {
    int rectangle = gl_VertexID / 6, corner = kCorner[gl_VertexID % 6];
    float down = 3.14159265 * float(rectangle / (2 * rings) + (corner >> 1)) / float(rings);
    float around = 3.14159265 * float(rectangle % (2 * rings) + (corner & 1)) / float(rings);
    vec3 direction = vec3(sin(down) * cos(around), cos(down), sin(down) * sin(around));
    gl_Position = projection * view * vec4(position_m.xyz + radius_m * direction, 1.0);
    normal = mat3(view) * direction;
    speed_m_per_s = length(velocity_m_per_s.xyz);
}
//! [mesh]
