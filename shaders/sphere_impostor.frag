#version 330 core
// One pixel of a sphere: where its ray meets the surface, which way the surface faces, how deep it lies.

flat in vec3 centre_m;
flat in float speed_m_per_s;
in vec3 ray;

uniform mat4 projection;
uniform float radius_m;
uniform float near_m;

layout(location = 0) out vec4 surface;  // normal in camera coordinates, speed in m/s

//! [impostor]
void main() {
    // The ray's point nearest to the centre. Subtracting first keeps the digits: the textbook's
    // b*b - 4*a*c loses them for a small sphere far away.
    float t_nearest = dot(centre_m, ray) / dot(ray, ray);
    vec3 off_centre = t_nearest * ray - centre_m;
    float half_chord2 = radius_m * radius_m - dot(off_centre, off_centre);
    if (half_chord2 < 0.0) discard;

    float t = t_nearest - sqrt(half_chord2 / dot(ray, ray));  // ray.z is -1, so t is the depth in metres
    if (t < near_m) discard;
    surface = vec4((t * ray - centre_m) / radius_m, speed_m_per_s);

    float clip_z = projection[3][2] - projection[2][2] * t;
    gl_FragDepth = 0.5 + 0.5 * clip_z / t;  // clip w is t
}
//! [impostor]
