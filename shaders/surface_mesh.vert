#version 330 core
// A vertex of a triangle mesh.

layout(location = 0) in vec4 position_m;  // xyz
layout(location = 1) in vec4 direction;   // xyz: the normal, if the mesh has any

uniform mat4 view;
uniform mat4 projection;

out vec3 seen_at;  // camera coordinates, as is the normal
out vec3 normal;

void main() {
    vec4 at = view * vec4(position_m.xyz, 1.0);
    seen_at = at.xyz;
    normal = mat3(view) * direction.xyz;
    gl_Position = projection * at;
}
