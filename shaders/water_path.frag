#version 330 core
// A ray on its way through the tank: marched through the field from one surface of the water to the next.

uniform sampler3D field;     // above iso in water, 0 far from it
uniform float iso;
uniform vec3 field_low_m;    // place of the texture's low corner
uniform vec3 field_size_m;   // of the texture
uniform float field_cell_m;
uniform sampler3D free_blocks;  // how many blocks around a block the surface surely is not
uniform float block_m;
uniform vec3 blocks_size_m;
uniform float wall_gap_m;    // nearer to the glass than this the water is taken to go on up to it
uniform float step_m;        // of the march
uniform vec3 absorption_per_m;
uniform vec3 scattered;  // colour of light that water itself sends to the eye, as if it came from all around
uniform float scattering_per_m;
uniform vec4 ball_m;
uniform vec3 tank_low_m;
uniform vec3 tank_high_m;

const float kWaterIndex = 1.333;
const int kMaxSteps = 400, kMaxCrossings = 7;
const float kNever = 1e9;

float fresnel(float cosine, float index);                                   // water_optics.frag
vec3 sky(vec3 towards);                                                     // water_stage.frag
vec3 ground_colour(vec3 p, float seen_m);                                   // water_stage.frag
float ball_distance(vec3 from, vec3 towards);                               // water_stage.frag
vec3 ball_colour(vec3 p, vec3 towards, bool in_water);                      // water_stage.frag
float wall_distance(vec3 p, vec3 towards, out vec3 normal);                 // water_tank.frag
vec3 leave(vec3 p, vec3 towards, vec3 normal, float seen_per_m, float way_m, bool with_sun);  // water_tank.frag

//! [water_at]
// Particles keep half a spacing off glass and ball, water does not: what the field is a little way off them, it is
// up to them.
vec3 off_walls(vec3 p) {
    p = clamp(p, tank_low_m + wall_gap_m, tank_high_m - wall_gap_m);
    vec3 off_ball = p - ball_m.xyz;
    float least = ball_m.w + wall_gap_m, away2 = dot(off_ball, off_ball);
    if (ball_m.w > 0.0 && away2 < least * least) p = ball_m.xyz + off_ball * (least * inversesqrt(max(away2, 1e-12)));
    return p - field_low_m;
}

// The field at p, above 0 in water.
float water_at(vec3 p) { return textureLod(field, off_walls(p) / field_size_m, 0.0).r - iso; }

// How far a ray from p may go, whichever way, and surely meet no surface.
float free_way(vec3 p) {
    vec3 in_field = off_walls(p) - 0.5 * field_cell_m;  // the first block starts at the first node
    return (textureLod(free_blocks, in_field / blocks_size_m, 0.0).r - 1.0) * block_m;
}
//! [water_at]

// Normal of the surface at p, out of the water.
vec3 water_normal(vec3 p) {
    vec3 h = vec3(field_cell_m, 0.0, 0.0);
    vec3 downhill = vec3(water_at(p - h.xyy) - water_at(p + h.xyy), water_at(p - h.yxy) - water_at(p + h.yxy),
                         water_at(p - h.yyx) - water_at(p + h.yyx));
    return normalize(downhill + vec3(0.0, 1e-9, 0.0));
}

//! [march]
// How far from p along `towards` the ray leaves the water (side 1) or meets it (side -1); kNever if not within
// `limit_m`. The first half step is not looked at: there lies the surface that the ray comes from.
float march(vec3 p, vec3 towards, float limit_m, float side) {
    float before_m = 0.5 * step_m, before = side * water_at(p + before_m * towards);
    for (int k = 0; k < kMaxSteps && before_m < limit_m; ++k) {
        float t_m = min(before_m + max(step_m, free_way(p + before_m * towards)), limit_m);
        float value = side * water_at(p + t_m * towards);
        if (value < 0.0) return before < 0.0 ? t_m : mix(before_m, t_m, before / (before - value));
        before_m = t_m;
        before = value;
    }
    return kNever;
}
//! [march]

//! [follow]
// The light that comes to p from the direction `towards`. At each surface the stronger of the two rays is
// followed; the weaker one gets the light of its direction from sky or water without a look at what is there.
vec3 follow(vec3 p, vec3 towards, bool in_water, float seen_per_m, float way_m) {
    vec3 light = vec3(0.0), share = vec3(1.0);
    for (int k = 0; k < kMaxCrossings; ++k) {
        vec3 normal;
        float to_wall = wall_distance(p, towards, normal), to_ball = ball_distance(p, towards);
        float to_solid = min(to_wall, to_ball);
        float t = march(p, towards, to_solid, in_water ? 1.0 : -1.0);
        bool at_surface = t < to_solid;
        t = min(t, to_solid);
        if (in_water) {
            light += share * (1.0 - exp(-scattering_per_m * t)) * scattered;
            share *= exp(-(absorption_per_m + scattering_per_m) * t);
        }
        p += t * towards;
        way_m += t;
        if (!at_surface) {
            if (to_ball < to_wall) return light + share * ball_colour(p, towards, in_water);
            if (normal.y > 0.5) {
                float seen_m = seen_per_m * way_m / max(-towards.y, 0.05);
                return light + share * ground_colour(p, seen_m);
            }
            if (!in_water) return light + share * leave(p, towards, normal, seen_per_m, way_m, true);
        } else {
            normal = water_normal(p);
            if (dot(normal, towards) > 0.0) normal = -normal;
        }
        float index = in_water ? 1.0 / kWaterIndex : kWaterIndex;
        float reflected = fresnel(min(1.0, -dot(normal, towards)), index);
        vec3 mirrored = reflect(towards, normal), bent = refract(towards, normal, 1.0 / index);
        if (reflected > 0.5) {
            if (reflected < 1.0) light += share * (1.0 - reflected) * (in_water ? sky(bent) : scattered);
            share *= reflected;
            towards = mirrored;
        } else {
            light += share * reflected * (in_water ? scattered : sky(vec3(mirrored.x, abs(mirrored.y), mirrored.z)));
            share *= 1.0 - reflected;
            towards = bent;
            if (!at_surface) return light + share * leave(p, towards, normal, seen_per_m, way_m, true);
            in_water = !in_water;
        }
    }
    return light + share * scattered;
}
//! [follow]

// Is there water behind the pane at p? Then light goes from air to glass to water, and the glass does not matter.
bool wet_pane(vec3 p, vec3 pane, vec3 towards, float way_m) { return water_at(p) > 0.0; }

// The direction of a ray from air after it has gone into the water.
vec3 way_in(vec3 towards, vec3 normal) { return refract(towards, normal, 1.0 / kWaterIndex); }
