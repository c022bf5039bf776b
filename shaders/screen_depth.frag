#version 330 core
// One pixel of one particle's sphere: its depth, and no more. The rectangle comes from sphere_impostor.vert.

flat in vec3 centre_m;
in vec3 ray;

uniform mat4 projection;
uniform float radius_m;
uniform float near_m;

layout(location = 0) out vec4 depth_m;  // in front of the eye's plane

void main() {
    float t_nearest = dot(centre_m, ray) / dot(ray, ray);
    vec3 off_centre = t_nearest * ray - centre_m;
    float half_chord2 = radius_m * radius_m - dot(off_centre, off_centre);
    if (half_chord2 < 0.0) discard;
    float t = t_nearest - sqrt(half_chord2 / dot(ray, ray));  // ray.z is -1, so t is the depth in metres
    if (t < near_m) discard;
    depth_m = vec4(t);
    gl_FragDepth = 0.5 + 0.5 * (projection[3][2] - projection[2][2] * t) / t;
}
