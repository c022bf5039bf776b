#version 330 core
// The first surface of the water that a ray from the eye meets, as it was drawn before: a mesh, or particles
// smoothed on the screen.

uniform sampler2D first_surface;  // normal in world coordinates, distance from the eye in m (0: no water)

const float kNever = 1e9;

// How far from p, which is `way_m` from the eye; kNever if not within limit_m.
float first_water(vec3 p, vec3 towards, float way_m, float limit_m, out vec3 normal) {
    vec4 seen = texelFetch(first_surface, ivec2(gl_FragCoord.xy), 0);
    float t = seen.w - way_m;
    normal = seen.xyz;
    return seen.w > 0.0 && t < limit_m ? max(t, 0.0) : kNever;
}
