#version 330 core
// What is solid: rods with round ends and the ground, lit by the fire. A ray for each pixel.

uniform mat4 projection;
uniform mat4 camera_to_world;
uniform vec2 picture_px;

uniform int ground;
uniform vec3 ground_colour;
uniform float ground_grain_m;
uniform vec3 sky_low;   // light of the sky at the horizon...
uniform vec3 sky_high;  // ...and overhead
uniform int light_count;
uniform vec4 light_at[4];  // position, size
uniform vec3 light_colour[4];
uniform int rod_count;
uniform vec4 rod_from[10];  // one end, radius
uniform vec4 rod_to[10];    // other end, embers
uniform int rod_material[10];

out vec4 result;

float noise(vec3 x);
float rough_noise(vec3 x);

//! [rod]
// Distance along the ray from `eye` (direction of length 1) to a cylinder with round ends, or -1. A candle's
// are flat.
float rod_distance(vec3 eye, vec3 ray, int k) {
    vec3 from = rod_from[k].xyz, to = rod_to[k].xyz;
    float radius = rod_from[k].w;
    vec3 axis = to - from, start = eye - from;
    float length2 = dot(axis, axis), axis_ray = dot(axis, ray), axis_start = dot(axis, start);
    float a = length2 - axis_ray * axis_ray;
    float b = length2 * dot(start, ray) - axis_start * axis_ray;
    float c = length2 * (dot(start, start) - radius * radius) - axis_start * axis_start;
    float root = b * b - a * c;
    if (root >= 0.0 && a > 1e-9 * length2) {
        float t = (-b - sqrt(root)) / a, along = axis_start + t * axis_ray;
        if (along > 0.0 && along < length2) return t;
    }
    float nearest = -1.0;
    if (rod_material[k] == 1) {
        float t = ((axis_ray < 0.0 ? length2 : 0.0) - axis_start) / axis_ray;
        vec3 off = eye + t * ray - (axis_ray < 0.0 ? to : from);
        return t > 0.0 && dot(off, off) < radius * radius ? t : -1.0;
    }
    for (int end = 0; end < 2; ++end) {
        vec3 from_centre = end == 0 ? start : eye - to;
        float h = dot(ray, from_centre), q = h * h - dot(from_centre, from_centre) + radius * radius;
        float t = -h - sqrt(max(q, 0.0));
        if (q > 0.0 && t > 0.0 && (nearest < 0.0 || t < nearest)) nearest = t;
    }
    return nearest;
}
//! [rod]

// How much of the light at `to` reaches x: rods between them cast shadows.
float lit(vec3 x, vec3 to, int except) {
    vec3 way = to - x;
    float far = length(way);
    for (int k = 0; k < rod_count; ++k) {
        if (k == except || rod_material[k] == 2) continue;
        float t = rod_distance(x, way / far, k);
        if (t > 0.0 && t < far) return 0.0;
    }
    return 1.0;
}

// Light on a surface at x that faces `normal`; `soft` is the part that comes around the edge.
vec3 light_on(vec3 x, vec3 normal, float soft, int except) {
    vec3 sum = sky_high * (0.5 + 0.5 * normal.y);
    for (int k = 0; k < light_count; ++k) {
        vec3 to_light = light_at[k].xyz - x;
        float size = light_at[k].w, d2 = dot(to_light, to_light) + size * size;
        // A flame is no point: four places in it make its shadows soft.
        float seen = 0.0;
        for (int s = 0; s < 4; ++s) {
            vec3 off = size * 0.7 * vec3(float(s & 1) - 0.5, 0.6 * float(s) - 0.9, float(s >> 1) - 0.5);
            seen += 0.25 * lit(x + 0.0005 * normal, light_at[k].xyz + off, except);
        }
        float facing = max((dot(normal, to_light) * inversesqrt(d2) + soft) / (1.0 + soft), 0.0);
        sum += light_colour[k] * (seen * facing / d2);
    }
    return sum;
}

// A normal as the slope of noise bends it; `p` is the place in units of the grain.
vec3 bent_normal(vec3 p, vec3 normal, float scale, float strength) {
    p *= scale;
    vec2 e = vec2(0.35, 0.0);
    float here = rough_noise(p);
    vec3 slope = (vec3(rough_noise(p + e.xyy), rough_noise(p + e.yxy), rough_noise(p + e.yyx)) - here) / e.x;
    return normalize(normal - strength * (slope - dot(slope, normal) * normal));
}

vec3 rod_light(int k, vec3 x) {
    vec3 from = rod_from[k].xyz, axis = rod_to[k].xyz - from;
    float along = clamp(dot(x - from, axis) / dot(axis, axis), 0.0, 1.0);
    vec3 normal = normalize(x - from - along * axis);
    float radius = rod_from[k].w;
    if (rod_material[k] == 2)  // a wick: black, with a glowing tip
        return vec3(0.010, 0.008, 0.007) * light_on(x, normal, 0.2, k) +
               rod_to[k].w * vec3(1.3, 0.20, 0.015) * smoothstep(0.86, 1.0, along);
    if (rod_material[k] == 1) {  // wax: light enters it and comes out elsewhere
        bool top = along > 0.9999;
        float molten = 0.0;
        if (top) {  // a clear pool around the wick, and a raised rim
            vec3 off = x - rod_to[k].xyz;
            float rim = smoothstep(0.74, 1.0, length(off) / radius);
            normal = normalize(vec3(0, 1, 0) - 0.8 * rim * off / radius);
            molten = 1.0 - smoothstep(0.66, 0.76, length(off) / radius);
        }
        vec3 sum = mix(vec3(0.80, 0.70, 0.56), vec3(0.42, 0.30, 0.18), molten) * light_on(x, normal, 0.3, k);
        vec3 mirrored = reflect(normalize(x - camera_to_world[3].xyz), vec3(0, 1, 0));
        for (int l = 0; l < light_count; ++l) {
            vec3 to_light = light_at[l].xyz - vec3(x.x, rod_to[k].y, x.z);
            float depth = top ? 0.0 : rod_to[k].y - x.y;
            float through = 1.0 - 0.5 * molten;
            sum += through * light_colour[l] / dot(to_light, to_light) *
                   vec3(0.40, 0.25, 0.12) * exp(-depth * vec3(0.55, 0.68, 0.85) / radius);
            // The pool mirrors the flame a little.
            float meets = max(dot(mirrored, normalize(to_light)), 0.0);
            sum += 0.5 * molten * pow(meets, 12.0) * light_colour[l] / dot(to_light, to_light);
        }
        return sum;
    }
    // Wood: bark along the rod, charred, with embers in its cracks where the fire is near.
    vec3 unit = normalize(axis);
    float run = dot(x - from, unit);
    vec3 across = (x - from) - run * unit;
    vec3 bark_at = (across + 0.3 * run * unit) / (0.25 * radius) + float(k) * 7.0;
    float bark = rough_noise(bark_at);
    vec3 bumpy = bent_normal(bark_at, normal, 1.0, 0.8);
    vec3 wood = mix(vec3(0.015, 0.012, 0.010), vec3(0.20, 0.12, 0.07), smoothstep(0.3, 0.75, bark));
    float embers = rod_to[k].w * smoothstep(0.15, 0.95, along);
    // Char breaks into blocks: dark plates between cracks in both directions.
    vec3 plate = (across + 0.8 * run * unit) / (0.42 * radius) + 0.8 * rough_noise(x / (0.5 * radius));
    float crack = 1.0 - smoothstep(0.02, 0.22, abs(noise(plate + float(k)) - 0.5));
    float patches = smoothstep(0.42, 0.75, rough_noise(x / (1.6 * radius) + 11.0));
    wood = mix(wood, vec3(0.022, 0.020, 0.020) + 0.05 * bark * bark, min(1.0, 1.2 * embers));
    float heat = embers * patches * (0.15 + crack * crack);
    return wood * light_on(x, bumpy, 0.15, k) + heat * heat * vec3(1.2, 0.15, 0.008);
}

vec3 ground_light(vec3 x) {
    if (ground_grain_m <= 0.0) {
        float streak = rough_noise(vec3(x.x * 6.0, 0.0, x.z * 90.0));  // a wooden table
        return ground_colour * (0.75 + 0.5 * streak) * light_on(x, vec3(0, 1, 0), 0.0, -1);
    }
    float lumps = rough_noise(x / ground_grain_m), fine = rough_noise(x / (0.17 * ground_grain_m));
    vec3 normal = bent_normal(x / ground_grain_m, vec3(0, 1, 0), 1.0, 0.5);
    normal = bent_normal(x / ground_grain_m, normal, 5.0, 0.35);
    return ground_colour * (0.35 + 0.7 * lumps + 0.5 * fine) * light_on(x, normal, 0.05, -1);
}

//! [stage_rays]
void main() {
    vec2 ndc = 2.0 * gl_FragCoord.xy / picture_px - 1.0;
    vec3 eye = camera_to_world[3].xyz;
    vec3 ray = mat3(camera_to_world) * vec3(ndc / vec2(projection[0][0], projection[1][1]), -1.0);
    float slant = length(ray);  // metres along the ray for a metre of depth
    ray /= slant;

    float distance_m = 1e4;
    int rod = -2;  // nothing; -1: the ground
    if (ground == 1 && ray.y < 0.0 && eye.y > 0.0 && eye.y < 1e4 * -ray.y) {
        distance_m = eye.y / -ray.y;
        rod = -1;
    }
    for (int k = 0; k < rod_count; ++k) {
        float t = rod_distance(eye, ray, k);
        if (t > 0.0 && t < distance_m) {
            distance_m = t;
            rod = k;
        }
    }
    vec3 x = eye + distance_m * ray;
    vec3 light = mix(sky_high, sky_low, exp(-3.0 * max(ray.y, 0.0)));
    if (rod >= 0) light = rod_light(rod, x);
    if (rod == -1) light = mix(sky_low, ground_light(x), exp(-0.06 * distance_m));  // the evening's haze
    result = vec4(light, 1.0);
    float depth_m = distance_m / slant;
    float clip_z = (-projection[2][2] * depth_m + projection[3][2]) / depth_m;
    gl_FragDepth = clamp(0.5 + 0.5 * clip_z, 0.0, 1.0);
}
//! [stage_rays]
