#version 330 core
// Which way the surface faces at a pixel; lighting.frag does the rest.

in vec3 seen_at;
in vec3 normal;

uniform bool flat_triangles;  // no normals: each triangle has the one of its plane

layout(location = 0) out vec4 surface;  // normal in camera coordinates; a speed of 0, which gives the colour

void main() {
    vec3 n = flat_triangles ? cross(dFdx(seen_at), dFdy(seen_at)) : normal;
    n = normalize(n);
    if (dot(n, seen_at) > 0.0) n = -n;  // seen from behind, or a normal that leans over at the outline
    surface = vec4(n, 0.0);
}
