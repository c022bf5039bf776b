#version 330 core
// The world without water: sky, a terrace, the tiled floor of the tank, a ball. World coordinates, linear light.

uniform sampler2D sky_map;
uniform vec3 to_sun;      // length 1
uniform vec3 sun_light;   // what falls on a surface that faces the sun
uniform vec3 sky_light;   // what falls on a level surface from all over the sky
uniform vec3 tank_low_m;  // the tank stands on the ground: its floor is the ground's plane
uniform vec3 tank_high_m;
uniform vec4 ball_m;  // middle and radius; radius 0: there is none
uniform sampler2D sunshine_map;  // the part of the sun's light that arrives on the ground
uniform vec4 sunshine_m;         // the rectangle that it covers: low x, low z, size x, size z
uniform bool caustics;

const float kTile_m = 0.05, kSlab_m = 0.40;
const float kNever = 1e9;

float tile_number(vec2 tile) {  // 0 to 1, as if drawn by lot
    vec3 q = fract(vec3(tile.xyx) * 0.1031);
    q += dot(q, q.yzx + 33.33);
    return fract((q.x + q.y) * q.z);
}

// Light from a direction, the sun's disc left out.
vec3 sky(vec3 towards) {
    vec2 place = vec2(atan(towards.x, towards.z) / 6.2831853 + 0.5, asin(clamp(towards.y, -1.0, 1.0)) / 3.1415927 + 0.5);
    return textureLod(sky_map, place, 0.0).rgb;
}

// The sun's disc, mirrored: a little wider than the real one, since ripples smaller than our cells spread it.
vec3 sun_disc(vec3 towards) {
    float cosine = dot(towards, to_sun);
    return sun_light * (90.0 * smoothstep(0.9993, 0.9998, cosine) + 0.8 * smoothstep(0.985, 1.0, cosine));
}

// The part of a stripe `width_m` wide around each multiple of `period_m` that a pixel sees which is `seen_m` wide.
float lines(float x_m, float period_m, float width_m, float seen_m) {
    float off_m = abs(fract(x_m / period_m + 0.5) - 0.5) * period_m;
    float wide_m = max(width_m, seen_m);  // what is finer than a pixel gets paler instead
    return clamp(0.5 + (0.5 * wide_m - off_m) / seen_m, 0.0, 1.0) * width_m / wide_m;
}

bool in_tank(vec2 place) {
    return all(greaterThan(place, tank_low_m.xz)) && all(lessThan(place, tank_high_m.xz));
}

// The part of light that the ground throws back. `seen_m`: what one pixel sees of it.
vec3 ground_albedo(vec2 place, float seen_m) {
    if (in_tank(place)) {
        vec2 tile = floor((place - tank_low_m.xz) / kTile_m);
        float lot = tile_number(tile + 3.0);
        vec3 glaze = mix(vec3(0.10, 0.36, 0.52), vec3(0.36, 0.64, 0.72), lot);
        if (lot > 0.86) glaze = vec3(0.78, 0.82, 0.80);
        if (lot < 0.10) glaze = vec3(0.05, 0.19, 0.36);
        glaze = mix(glaze, vec3(0.25, 0.50, 0.62), smoothstep(0.3, 1.0, seen_m / kTile_m));
        float grout = max(lines(place.x - tank_low_m.x, kTile_m, 0.004, seen_m), lines(place.y - tank_low_m.z, kTile_m, 0.004, seen_m));
        return mix(glaze, vec3(0.80, 0.82, 0.80), grout);
    }
    float lot = tile_number(floor(place / kSlab_m) + 11.0);
    vec3 stone = mix(vec3(0.33, 0.30, 0.26), vec3(0.40, 0.365, 0.32), lot);
    float joint = max(lines(place.x, kSlab_m, 0.006, seen_m), lines(place.y, kSlab_m, 0.006, seen_m));
    return mix(stone, vec3(0.17, 0.155, 0.14), joint);
}

// The sun's light on the ground at `place`, as a part of what would arrive without water.
float sunshine(vec2 place) {
    vec2 on_map = (place - sunshine_m.xy) / sunshine_m.zw;
    if (!caustics || any(lessThan(on_map, vec2(0.0))) || any(greaterThan(on_map, vec2(1.0)))) return 1.0;
    return max(0.0, textureLod(sunshine_map, on_map, 0.0).r);
}

// The part of the sky that a ball leaves free over a point of the ground (the rest is the ball itself).
float open_sky(vec2 place) {
    if (ball_m.w == 0.0) return 1.0;
    vec3 to_ball = ball_m.xyz - vec3(place.x, tank_low_m.y, place.y);
    float away2 = dot(to_ball, to_ball);
    return 1.0 - clamp(to_ball.y / sqrt(away2), 0.0, 1.0) * min(1.0, ball_m.w * ball_m.w / away2);
}

vec3 ground_colour(vec3 p, float seen_m) {
    vec3 light = open_sky(p.xz) * sky_light + sunshine(p.xz) * to_sun.y * sun_light;
    return ground_albedo(p.xz, seen_m) * light;
}

float ground_distance(vec3 from, vec3 towards) {
    float height = from.y - tank_low_m.y;
    return towards.y < 0.0 && height >= 0.0 ? -height / towards.y : kNever;
}

float ball_distance(vec3 from, vec3 towards) {
    if (ball_m.w == 0.0) return kNever;
    vec3 to_middle = ball_m.xyz - from;
    float nearest = dot(to_middle, towards);
    vec3 off = to_middle - nearest * towards;
    float half_chord2 = ball_m.w * ball_m.w - dot(off, off);
    if (half_chord2 <= 0.0) return kNever;
    float t = nearest - sqrt(half_chord2);
    return t > 1e-4 ? t : kNever;
}

// A ball of glazed clay in two colours. `towards`: of the ray that meets it at p.
vec3 ball_colour(vec3 p, vec3 towards, bool in_water) {
    vec3 normal = (p - ball_m.xyz) / ball_m.w;
    float sun = max(0.0, dot(normal, to_sun));
    vec3 albedo = abs(normal.y) < 0.28 ? vec3(0.86, 0.82, 0.74) : vec3(0.80, 0.17, 0.06);
    vec3 light = mix(0.35 * vec3(0.4, 0.42, 0.42), sky_light, 0.5 + 0.5 * normal.y) + sun * sun_light;
    vec3 colour = albedo * light;
    if (in_water) return colour;
    vec3 mirrored = reflect(towards, normal);
    float mirror = 0.04 + 0.96 * pow(1.0 - max(0.0, -dot(towards, normal)), 5.0);
    return mix(colour, mirrored.y > 0.0 ? sky(mirrored) : 0.4 * sky_light, mirror) + mirror * sun_disc(mirrored);
}

// What a ray sees that meets no water any more. `seen_m`: how much of the ground a pixel sees per metre of its way.
vec3 stage(vec3 from, vec3 towards, float seen_per_m, bool with_sun) {
    float to_ground = ground_distance(from, towards), to_ball = ball_distance(from, towards);
    if (to_ball < to_ground) return ball_colour(from + to_ball * towards, towards, false);
    vec3 beyond = sky(vec3(towards.x, max(towards.y, 0.002), towards.z));
    if (to_ground == kNever) return with_sun ? beyond + sun_disc(towards) : beyond;
    vec3 p = from + to_ground * towards;
    float haze = 1.0 - exp(-0.035 * to_ground);
    return mix(ground_colour(p, seen_per_m * to_ground / max(-towards.y, 0.02)), beyond, haze);
}
