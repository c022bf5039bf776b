#version 330 core
// What is seen where there is no particle: a floor that fades into a sky. World coordinates, linear light.

uniform vec3 sky_colour;  // overhead
uniform vec3 horizon_colour;
uniform vec3 ground_colour;   // the part of the light that the floor throws back
uniform vec3 floor_centre_m;  // the floor is the plane through it
uniform float floor_tile_m;   // distance of the floor's lines
uniform float floor_fade_m;   // farther than this from its centre the floor fades into the horizon
uniform float pixel_rad;      // angle that one pixel sees

// Light that comes from `direction` (length 1).
vec3 sky(vec3 direction) { return mix(horizon_colour, sky_colour, smoothstep(0.0, 0.9, direction.y)); }

// Does a ray from `eye` along `ray` meet the floor? The distance in units of `ray`, or -1.
float floor_distance(vec3 eye, vec3 ray) {
    float height = floor_centre_m.y - eye.y;
    return height < 0.0 && ray.y < 0.0 ? height / ray.y : -1.0;
}

// The part of a pixel that floor lines cover, if it sees `width_m` of the floor around x.
float line_cover(float x_m, float width_m) {
    float line_m = 0.008 * floor_tile_m;
    float off_m = abs(fract(x_m / floor_tile_m + 0.5) - 0.5) * floor_tile_m;
    float seen_m = max(line_m, width_m);  // a line thinner than a pixel gets paler instead
    return clamp(0.5 + (0.5 * seen_m - off_m) / width_m, 0.0, 1.0) * line_m / seen_m;
}

// The floor's colour at p; `light` is what falls on it.
vec3 floor_colour(vec3 p, vec3 eye, vec3 light) {
    vec3 to_eye = eye - p;
    float width_m = pixel_rad * dot(to_eye, to_eye) / to_eye.y;
    vec2 place = p.xz - floor_centre_m.xz;
    float line = max(line_cover(place.x, width_m), line_cover(place.y, width_m));
    float away = length(place) / floor_fade_m;
    return mix(horizon_colour, ground_colour * light * (1.0 - 0.3 * line), exp(-away * away));
}
