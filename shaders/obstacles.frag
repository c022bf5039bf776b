#version 330 core
// Puts solid spheres and boxes into a picture that has been drawn: a ray a sample, the nearer of obstacle and
// picture, and the obstacles' shadows on what the picture shows.

uniform sampler2D scene;        // linear light
uniform sampler2D scene_depth;  // 1 where there is no particle
uniform mat4 projection;
uniform mat4 camera_to_world;
uniform vec3 to_light;  // length 1
uniform vec3 key_light;
uniform vec3 ground_colour;

const int kMost = 4;
uniform int count;
uniform int is_box[kMost];
uniform vec3 middle_m[kMost];
uniform vec3 half_size_m[kMost];
uniform vec3 paint;  // what the obstacles reflect

out vec4 colour;  // linear light: the framebuffer makes it sRGB

vec3 sky(vec3 direction);                  // backdrop.frag
float floor_distance(vec3 eye, vec3 ray);  // backdrop.frag

const float kNever = 1e20;

// Where a ray enters obstacle k, in units of `ray`, or kNever.
float entry(int k, vec3 eye, vec3 ray, out vec3 normal) {
    vec3 from = eye - middle_m[k];
    normal = vec3(0.0);
    if (is_box[k] == 0) {
        float nearest = -dot(from, ray) / dot(ray, ray);
        vec3 off = from + nearest * ray;
        float half_chord2 = half_size_m[k].x * half_size_m[k].x - dot(off, off);
        if (half_chord2 < 0.0) return kNever;
        float t = nearest - sqrt(half_chord2 / dot(ray, ray));
        if (t < 0.0) return kNever;
        normal = (from + t * ray) / half_size_m[k].x;
        return t;
    }
    vec3 a = (-half_size_m[k] - from) / ray, b = (half_size_m[k] - from) / ray;
    vec3 in3 = min(a, b), out3 = max(a, b);
    float t = max(in3.x, max(in3.y, in3.z));
    if (t < 0.0 || t > min(out3.x, min(out3.y, out3.z))) return kNever;
    normal = -sign(ray) * vec3(equal(in3, vec3(t)));
    return t;
}

float distance_m(int k, vec3 p) {
    vec3 r = p - middle_m[k];
    if (is_box[k] == 0) return length(r) - half_size_m[k].x;
    vec3 beyond = abs(r) - half_size_m[k];
    return length(max(beyond, vec3(0.0))) + min(0.0, max(beyond.x, max(beyond.y, beyond.z)));
}

float noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// The part of the light that obstacles leave for a point: its key light blocked by a ray towards a light that is
// some degrees wide, and what comes from all around by how near they are.
float left_over(vec3 p, float turn) {
    float angle = 6.2831853 * turn;
    vec3 side = normalize(cross(to_light, vec3(0.0, 0.0, 1.0)));
    vec3 towards = to_light + 0.06 * sqrt(turn) * (cos(angle) * side + sin(angle) * cross(to_light, side));
    float lit = 1.0, open = 1.0;
    for (int k = 0; k < count; ++k) {
        vec3 normal;
        float size = max(half_size_m[k].x, max(half_size_m[k].y, half_size_m[k].z));
        if (entry(k, p, towards, normal) < kNever) lit = 0.0;
        open *= mix(0.45, 1.0, smoothstep(0.0, 0.7 * size, distance_m(k, p)));
    }
    return mix(0.38 * open, 0.65 + 0.35 * open, lit);
}

vec3 solid_colour(vec3 p, vec3 normal, vec3 to_eye, float turn) {
    vec3 around = mix(0.9 * ground_colour, 1.6 * sky(vec3(0.0, 1.0, 0.0)), 0.5 + 0.5 * normal.y);
    float lit = max(0.0, dot(normal, to_light));
    for (int k = 0; k < count; ++k) {  // one obstacle in another's shadow
        vec3 other;
        if (entry(k, p + 1e-4 * normal, to_light, other) < kNever) lit = 0.0;
    }
    vec3 mirrored = reflect(-to_eye, normal);
    float mirror = 0.04 + 0.96 * pow(1.0 - max(0.0, dot(normal, to_eye)), 5.0);
    float glint = pow(max(0.0, dot(mirrored, to_light)), 40.0) * (lit > 0.0 ? 1.0 : 0.0);
    return paint * (around + lit * key_light) + 0.35 * mirror * sky(mirrored) + 0.25 * glint * key_light;
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 eye = camera_to_world[3].xyz, drawn = texelFetch(scene, pixel, 0).rgb;
    float depth = texelFetch(scene_depth, pixel, 0).r, nearest = kNever;
    vec3 sum = vec3(0.0);
    for (int k = 0; k < 4; ++k) {
        vec2 at = 2.0 * (vec2(pixel) + 0.25 + 0.5 * vec2(k & 1, k >> 1)) / vec2(textureSize(scene, 0)) - 1.0;
        vec3 ray = mat3(camera_to_world) * vec3(at / vec2(projection[0][0], projection[1][1]), -1.0);
        float turn = fract(noise(gl_FragCoord.xy) + 0.618034 * float(k));
        float scene_t = depth < 1.0 ? projection[3][2] / (2.0 * depth - 1.0 + projection[2][2])
                                    : floor_distance(eye, ray);
        if (scene_t < 0.0) scene_t = kNever;
        float t = kNever;
        vec3 normal = vec3(0.0);
        for (int o = 0; o < count; ++o) {
            vec3 n;
            float enter = entry(o, eye, ray, n);
            if (enter >= t) continue;
            t = enter;
            normal = n;
        }
        if (t < scene_t) {
            sum += solid_colour(eye + t * ray, normal, -normalize(ray), turn);
        } else {
            sum += scene_t < kNever ? drawn * left_over(eye + scene_t * ray, turn) : drawn;
        }
        nearest = min(nearest, min(t, depth < 1.0 ? scene_t : kNever));
    }
    colour = vec4(0.25 * sum, 1.0);
    gl_FragDepth = nearest < kNever ? 0.5 + 0.5 * (projection[3][2] / nearest - projection[2][2]) : 1.0;
}
