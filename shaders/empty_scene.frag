#version 330 core
// Floor and sky alone, before points are drawn.

uniform mat4 projection;
uniform mat4 camera_to_world;
uniform vec3 floor_light;
uniform vec2 picture_px;

out vec4 colour;  // linear light: the framebuffer makes it sRGB

vec3 sky(vec3 direction);                         // backdrop.frag
float floor_distance(vec3 eye, vec3 ray);         // backdrop.frag
vec3 floor_colour(vec3 p, vec3 eye, vec3 light);  // backdrop.frag

void main() {
    vec2 in_picture = 2.0 * gl_FragCoord.xy / picture_px - 1.0;
    vec3 ray = vec3(in_picture / vec2(projection[0][0], projection[1][1]), -1.0);
    vec3 eye = camera_to_world[3].xyz, world_ray = mat3(camera_to_world) * ray;
    float t = floor_distance(eye, world_ray);
    colour = vec4(t > 0.0 ? floor_colour(eye + t * world_ray, eye, floor_light) : sky(normalize(world_ray)), 1.0);
    gl_FragDepth = 1.0;  // whatever is drawn later is in front
}
