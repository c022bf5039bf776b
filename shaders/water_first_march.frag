#version 330 core
// The first surface of the water that a ray from the eye meets, found by marching: no mesh at all.

const float kNever = 1e9;

vec3 water_normal(vec3 p);                                     // water_path.frag
float march(vec3 p, vec3 towards, float limit_m, float side);  // water_path.frag

// How far from p, which is `way_m` from the eye; kNever if not within limit_m.
float first_water(vec3 p, vec3 towards, float way_m, float limit_m, out vec3 normal) {
    float t = march(p, towards, limit_m, -1.0);
    normal = t < limit_m ? water_normal(p + t * towards) : -towards;
    return t;
}
