#version 330 core
// A corner of the water's mesh. Particles keep off the glass, water does not: what is nearer to a wall than the gap
// is moved to the wall.

layout(location = 0) in vec4 position_m;
layout(location = 1) in vec4 normal;

uniform mat4 view;
uniform mat4 projection;
uniform vec3 tank_low_m;
uniform vec3 tank_high_m;
uniform float wall_gap_m;

out vec3 place_m;
out vec3 outward;

void main() {
    place_m = position_m.xyz;
    vec3 low = vec3(lessThan(place_m, tank_low_m + wall_gap_m));
    vec3 high = vec3(greaterThan(place_m, tank_high_m - wall_gap_m)) * vec3(1.0, 0.0, 1.0);  // no lid
    place_m = mix(mix(place_m, tank_low_m, low), tank_high_m, high);
    outward = normal.xyz;
    gl_Position = projection * view * vec4(place_m, 1.0);
}
