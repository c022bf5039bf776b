#version 330 core
// What one particle adds to the water along a pixel's ray: its chord, scaled so that many of them add up to as much
// water as they carry.

flat in vec3 centre_m;
in vec3 ray;

uniform float radius_m;
uniform float water_per_chord;  // volume of a particle's water / volume of its sphere

layout(location = 0) out vec4 thickness_m;

void main() {
    float t_nearest = dot(centre_m, ray) / dot(ray, ray);
    vec3 off_centre = t_nearest * ray - centre_m;
    float half_chord2 = radius_m * radius_m - dot(off_centre, off_centre);
    if (half_chord2 < 0.0) discard;
    thickness_m = vec4(water_per_chord * 2.0 * sqrt(half_chord2));
}
