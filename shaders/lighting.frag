#version 330 core
// Lights each pixel once, after all spheres are drawn. It takes several samples a pixel, so that outlines and the
// edges of shadows are smooth.

uniform sampler2D surface;  // normal in camera coordinates, speed in m/s
uniform sampler2D depth_map;
uniform int samples;  // per pixel and axis
uniform mat4 projection;
uniform mat4 camera_to_world;

uniform bool shadows;
uniform sampler2D shadow_map;
uniform mat4 world_to_shadow;  // to [0, 1] in x, y and depth
uniform float shadow_edge;     // half the width of a shadow's soft edge, in those units
uniform vec3 to_light;         // world coordinates, length 1
uniform vec3 key_light;
uniform vec3 ground_colour;

out vec4 colour;  // linear light: the framebuffer makes it sRGB

vec3 palette(float speed_m_per_s);                            // palette.frag
vec3 sky(vec3 direction);                                     // backdrop.frag
float floor_distance(vec3 eye, vec3 ray);                     // backdrop.frag
vec3 floor_colour(vec3 p, vec3 eye, vec3 light);              // backdrop.frag
vec3 seen_point(ivec2 texel);                                 // openness.frag
float openness(vec3 p, vec3 normal, float turn);              // openness.frag

const vec3 kUp = vec3(0.0, 1.0, 0.0);

// A number in [0, 1) that looks random from pixel to pixel and is the same in every run.
float noise(vec2 pixel) { return fract(52.9829189 * fract(dot(pixel, vec2(0.06711056, 0.00583715)))); }

// The part of the key light that arrives at world point p.
float sunlit(vec3 p, float turn) {
    if (!shadows) return 1.0;
    vec3 at = (world_to_shadow * vec4(p, 1.0)).xyz;
    if (any(lessThan(at, vec3(0.0))) || any(greaterThan(at, vec3(1.0)))) return 1.0;  // not on the map
    float angle = 6.2831853 * turn;
    vec2 off = shadow_edge * sqrt(turn) * vec2(cos(angle), sin(angle));
    // A point is shaded by what is nearer to the light, but not by its own sphere: hence the + shadow_edge.
    float lit = texture(shadow_map, at.xy + off).r + shadow_edge < at.z ? 0.0 : 0.5;
    return texture(shadow_map, at.xy - off).r + shadow_edge < at.z ? lit : lit + 0.5;
}

//! [sphere_colour]
vec3 sphere_colour(vec3 normal, vec3 to_eye, float speed_m_per_s, float open, float sun) {
    // Light from all around: the sky from above, what the floor throws back from below.
    vec3 around = mix(0.6 * ground_colour, 1.3 * sky(kUp), 0.5 + 0.5 * normal.y);
    // The key light, a little round the edge: light scattered in water does not stop where the sun sets.
    float facing = max(0.0, (dot(normal, to_light) + 0.25) / 1.25);
    vec3 matte = palette(speed_m_per_s) * (open * around + facing * sun * key_light);

    // The mirror image of sky and key light. Schlick's formula for how much of it water shows.
    vec3 mirrored = reflect(-to_eye, normal);
    float mirror = 0.02 + 0.98 * pow(1.0 - max(0.0, dot(normal, to_eye)), 5.0);
    float glint = pow(max(0.0, dot(mirrored, to_light)), 60.0);
    return (1.0 - mirror) * matte + 0.6 * mirror * open * sky(mirrored) + 0.5 * glint * sun * key_light;
}
//! [sphere_colour]

void main() {
    vec3 eye = camera_to_world[3].xyz;
    vec3 sum = vec3(0.0);
    float nearest = 1.0;
    for (int k = 0; k < samples * samples; ++k) {
        ivec2 texel = samples * ivec2(gl_FragCoord.xy) + ivec2(k % samples, k / samples);
        vec2 in_picture = 2.0 * (vec2(texel) + 0.5) / vec2(textureSize(depth_map, 0)) - 1.0;
        vec3 ray = vec3(in_picture / vec2(projection[0][0], projection[1][1]), -1.0);
        vec3 world_ray = mat3(camera_to_world) * ray;
        float turn = fract(noise(gl_FragCoord.xy) + 0.618034 * float(k));

        vec3 p = seen_point(texel);
        float floor_t = floor_distance(eye, world_ray);
        if (p.z < 0.0 && (floor_t < 0.0 || -p.z < floor_t)) {
            vec4 s = texelFetch(surface, texel, 0);
            vec3 world = eye - p.z * world_ray;
            sum += sphere_colour(mat3(camera_to_world) * s.xyz, -normalize(world_ray), s.w,
                                 openness(p, s.xyz, turn), sunlit(world, turn));
            nearest = min(nearest, texelFetch(depth_map, texel, 0).r);
        } else if (floor_t > 0.0) {
            vec3 world = eye + floor_t * world_ray;
            float open = openness(floor_t * ray, kUp * mat3(camera_to_world), turn);
            vec3 light = open * sky(kUp) + to_light.y * sunlit(world, turn) * key_light;
            sum += floor_colour(world, eye, light);
        } else {
            sum += sky(normalize(world_ray));
        }
    }
    colour = vec4(sum / float(samples * samples), 1.0);
    gl_FragDepth = nearest;  // for what is drawn over it later
}
