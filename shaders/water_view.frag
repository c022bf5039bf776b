#version 330 core
// One sample of one pixel: the eye's ray to the tank, to the water, and on.

uniform mat4 projection;
uniform mat4 camera_to_world;
uniform vec2 picture_px;
uniform float pixel_rad;

out vec4 colour;  // linear light

const float kWaterIndex = 1.333;
const float kNever = 1e9;

float fresnel(float cosine, float index);                              // water_optics.frag
float pane_reflection(float cosine);                                   // water_optics.frag
vec3 stage(vec3 from, vec3 towards, float seen_per_m, bool with_sun);  // water_stage.frag
float ball_distance(vec3 from, vec3 towards);                          // water_stage.frag
float enter_tank(vec3 eye, vec3 towards, out vec3 normal);             // water_tank.frag
float wall_distance(vec3 p, vec3 towards, out vec3 normal);            // water_tank.frag
vec3 behind_glass(vec3 seen, vec3 p, vec3 normal, float seen_m);       // water_tank.frag
float first_water(vec3 p, vec3 towards, float way_m, float limit_m, out vec3 normal);  // water_first_*.frag
bool wet_pane(vec3 p, vec3 pane, vec3 towards, float way_m);           // water_path.frag or water_thickness.frag
vec3 follow(vec3 p, vec3 towards, bool in_water, float seen_per_m, float way_m);       // the same
vec3 way_in(vec3 towards, vec3 normal);                                                 // the same

//! [surface_light]
// The light from a surface of water at p: what it mirrors and what comes through it, each with its part.
vec3 surface_light(vec3 p, vec3 towards, vec3 normal, float way_m) {
    if (dot(normal, towards) > 0.0) normal = reflect(normal, towards);  // seen from behind by a hair's breadth
    float mirrored = fresnel(min(1.0, -dot(normal, towards)), kWaterIndex);
    return mirrored * follow(p, reflect(towards, normal), false, pixel_rad, way_m) +
           (1.0 - mirrored) * follow(p, way_in(towards, normal), true, pixel_rad, way_m);
}
//! [surface_light]

// The light through a pane with water behind it at p.
vec3 wet_pane_light(vec3 p, vec3 towards, vec3 pane, float way_m) {
    float mirrored = fresnel(min(1.0, -dot(pane, towards)), kWaterIndex);
    return mirrored * stage(p, reflect(towards, pane), pixel_rad, true) +
           (1.0 - mirrored) * follow(p, way_in(towards, pane), true, pixel_rad, way_m);
}

// The light from inside the tank, for a ray that is at p in its air.
vec3 air_light(vec3 p, vec3 towards, float way_m) {
    vec3 wall, normal;
    float to_solid = min(wall_distance(p, towards, wall), ball_distance(p, towards));
    float to_water = first_water(p, towards, way_m, to_solid, normal);
    if (to_water >= to_solid) return follow(p, towards, false, pixel_rad, way_m);
    return surface_light(p + to_water * towards, towards, normal, way_m + to_water);
}

void main() {
    vec2 in_picture = 2.0 * gl_FragCoord.xy / picture_px - 1.0 + projection[2].xy;
    vec3 eye = camera_to_world[3].xyz;
    vec3 towards = normalize(mat3(camera_to_world) * vec3(in_picture / vec2(projection[0][0], projection[1][1]), -1.0));
    vec3 pane;
    float way_m = enter_tank(eye, towards, pane);
    if (way_m == kNever || ball_distance(eye, towards) < way_m) {
        colour = vec4(stage(eye, towards, pixel_rad, false), 1.0);
        return;
    }
    bool inside = way_m <= 0.0, glass = !inside && pane.y < 0.5;  // the top is open
    way_m = max(way_m, 0.0);
    vec3 p = eye + way_m * towards;
    vec3 light;
    if (!inside && wet_pane(p, pane, towards, way_m)) {
        light = wet_pane_light(p, towards, pane, way_m);
    } else {
        light = air_light(p, towards, way_m);
        if (glass) light = mix(light, stage(p, reflect(towards, pane), pixel_rad, false), pane_reflection(min(1.0, -dot(pane, towards))));
    }
    if (glass) light = behind_glass(light, p, pane, pixel_rad * way_m);
    colour = vec4(light, 1.0);
}
