#version 330 core
// Water without a look inside: a ray is bent once, where it goes in, and then crosses as much water as the
// picture shows at this pixel.

uniform sampler2D thickness_map;  // of all water along the straight ray, in m
uniform bool bend;                // false: straight through
uniform float wall_gap_m;
uniform vec3 absorption_per_m;
uniform vec3 scattered;
uniform float scattering_per_m;

const float kWaterIndex = 1.333;
const float kNever = 1e9;

vec3 ground_colour(vec3 p, float seen_m);                                                     // water_stage.frag
float ball_distance(vec3 from, vec3 towards);                                                 // water_stage.frag
vec3 ball_colour(vec3 p, vec3 towards, bool in_water);                                        // water_stage.frag
float wall_distance(vec3 p, vec3 towards, out vec3 normal);                                   // water_tank.frag
vec3 leave(vec3 p, vec3 towards, vec3 normal, float seen_per_m, float way_m, bool with_sun);  // water_tank.frag
float first_water(vec3 p, vec3 towards, float way_m, float limit_m, out vec3 normal);         // water_first_drawn.frag

// Is there water behind the pane at p? Yes if it is seen within the gap that particles keep off the glass.
bool wet_pane(vec3 p, vec3 pane, vec3 towards, float way_m) {
    vec3 normal;
    return first_water(p, towards, way_m, kNever, normal) * -dot(pane, towards) < 1.5 * wall_gap_m;
}

// The direction of a ray from air after it has gone into the water.
vec3 way_in(vec3 towards, vec3 normal) { return bend ? refract(towards, normal, 1.0 / kWaterIndex) : towards; }

//! [thickness]
vec3 follow(vec3 p, vec3 towards, bool in_water, float seen_per_m, float way_m) {
    vec3 normal;
    float to_wall = wall_distance(p, towards, normal), to_ball = ball_distance(p, towards);
    float to_solid = min(to_wall, to_ball);
    vec3 light = vec3(0.0), share = vec3(1.0);
    if (in_water) {
        float wet_m = min(to_solid, texelFetch(thickness_map, ivec2(gl_FragCoord.xy), 0).r);
        light = (1.0 - exp(-scattering_per_m * wet_m)) * scattered;
        share = exp(-(absorption_per_m + scattering_per_m) * wet_m);
    }
    p += to_solid * towards;
    way_m += to_solid;
    if (to_ball < to_wall) return light + share * ball_colour(p, towards, in_water);
    if (normal.y > 0.5) return light + share * ground_colour(p, seen_per_m * way_m / max(-towards.y, 0.05));
    return light + share * leave(p, towards, normal, seen_per_m, way_m, true);
}
//! [thickness]
