#version 330 core
// The glass tank: where rays cross its walls, and what they see of the glass.

uniform vec3 tank_low_m;
uniform vec3 tank_high_m;

const float kNever = 1e9;

vec3 stage(vec3 from, vec3 towards, float seen_per_m, bool with_sun);  // water_stage.frag

// Where a ray that starts in the tank leaves it, and the wall's normal there, into the tank.
float wall_distance(vec3 p, vec3 towards, out vec3 normal) {
    vec3 away = mix(tank_low_m - p, tank_high_m - p, greaterThan(towards, vec3(0.0)));
    vec3 t = vec3(towards.x == 0.0 ? kNever : away.x / towards.x, towards.y == 0.0 ? kNever : away.y / towards.y,
                  towards.z == 0.0 ? kNever : away.z / towards.z);
    float first = min(t.x, min(t.y, t.z));
    normal = t.x == first ? vec3(1, 0, 0) : t.y == first ? vec3(0, 1, 0) : vec3(0, 0, 1);
    normal *= -sign(dot(normal, towards));
    return max(first, 0.0);
}

// Where the ray from outside enters the tank, and the wall's normal there, out of the tank; or kNever.
float enter_tank(vec3 eye, vec3 towards, out vec3 normal) {
    vec3 t_low = (tank_low_m - eye) / towards, t_high = (tank_high_m - eye) / towards;
    vec3 t_in = min(t_low, t_high), t_out = max(t_low, t_high);
    float first = max(t_in.x, max(t_in.y, t_in.z)), last = min(t_out.x, min(t_out.y, t_out.z));
    normal = t_in.x == first ? vec3(1, 0, 0) : t_in.y == first ? vec3(0, 1, 0) : vec3(0, 0, 1);
    normal *= -sign(dot(normal, towards));
    return first < last && last > 0.0 ? first : kNever;
}

// The part of the wall at p that is its polished edge.
float rim(vec3 p, vec3 normal, float seen_m) {
    vec3 off = min(p - tank_low_m, tank_high_m - p) + abs(normal);  // + 1 m along the normal: not that one
    float edge_m = min(off.x, min(off.y, off.z));
    return clamp(0.5 + (0.0035 - edge_m) / max(seen_m, 1e-5), 0.0, 1.0);
}

// What is seen through a wall at p, its edge included: greenish, as the edges of panes are.
vec3 behind_glass(vec3 seen, vec3 p, vec3 normal, float seen_m) {
    return mix(seen, vec3(0.30, 0.46, 0.44), 0.7 * rim(p, normal, seen_m));
}

// Out of the tank's air through a wall or the open top.
vec3 leave(vec3 p, vec3 towards, vec3 normal, float seen_per_m, float way_m, bool with_sun) {
    vec3 seen = stage(p, towards, seen_per_m, with_sun);
    if (normal.y < -0.5) return seen;  // no lid
    return behind_glass(seen, p, normal, seen_per_m * way_m);
}
