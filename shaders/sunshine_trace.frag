#version 330 core
// One photon of the sun a texel: where on the ground does it land? Without water it would land at the texel itself.

uniform vec2 picture_px;
uniform vec3 to_sun;
uniform vec4 sunshine_m;
uniform vec3 tank_low_m;
uniform vec3 tank_high_m;

out vec4 landing;  // x and z in m, the part of the photon that arrives but for absorption, its way in water in m

const float kWaterIndex = 1.333;
const float kNever = 1e9;
const int kMaxPhotonCrossings = 6;

float fresnel(float cosine, float index);
float pane_reflection(float cosine);
float ball_distance(vec3 from, vec3 towards);
float ground_distance(vec3 from, vec3 towards);
float water_at(vec3 p);
vec3 water_normal(vec3 p);
float march(vec3 p, vec3 towards, float limit_m, float side);
float wall_distance(vec3 p, vec3 towards, out vec3 normal);
float enter_tank(vec3 eye, vec3 towards, out vec3 normal);

void main() {
    vec2 straight = sunshine_m.xy + sunshine_m.zw * gl_FragCoord.xy / picture_px;
    vec3 towards = -to_sun, from = vec3(straight.x, tank_low_m.y, straight.y) + 10.0 * to_sun, normal;
    landing = vec4(straight, 1.0, 0.0);
    float t = enter_tank(from, towards, normal);
    if (t == kNever) return;
    vec3 p = from + t * towards;
    float share = 1.0, wet_m = 0.0;
    bool in_water = water_at(p) > 0.0;
    if (normal.y < 0.5) share *= 1.0 - pane_reflection(min(1.0, -dot(normal, towards)));
    if (in_water) towards = refract(towards, normal, 1.0 / kWaterIndex);
    for (int k = 0; k < kMaxPhotonCrossings; ++k) {
        float to_wall = wall_distance(p, towards, normal), to_ball = ball_distance(p, towards);
        float to_solid = min(to_wall, to_ball);
        t = march(p, towards, to_solid, in_water ? 1.0 : -1.0);
        bool at_surface = t < to_solid;
        t = min(t, to_solid);
        if (in_water) wet_m += t;
        p += t * towards;
        if (!at_surface) {
            if (to_ball < to_wall) share = 0.0;
            if (to_ball < to_wall || normal.y > 0.5) break;
            if (!in_water) {  // out through a wall
                if (normal.y > -0.5) share *= 1.0 - pane_reflection(min(1.0, -dot(normal, towards)));
                float down = ground_distance(p, towards);
                share = down < kNever ? share : 0.0;
                p += min(down, 100.0) * towards;
                break;
            }
        } else {
            normal = water_normal(p);
            if (dot(normal, towards) > 0.0) normal = -normal;
        }
        float index = in_water ? 1.0 / kWaterIndex : kWaterIndex;
        float reflected = fresnel(min(1.0, -dot(normal, towards)), index);
        if (reflected > 0.5) {
            share *= reflected;
            towards = reflect(towards, normal);
        } else {
            share *= 1.0 - reflected;
            towards = refract(towards, normal, 1.0 / index);
            in_water = !in_water;
        }
        // A photon on its way up is lost: what it would light is not the ground.
    }
    landing = vec4(p.xz, p.y < tank_low_m.y + 1e-3 ? share : 0.0, wet_m);
}
