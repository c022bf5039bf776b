#version 330 core
// The sky as a picture, drawn once: every ray that leaves the scene looks it up. Across: the compass; up: from
// straight down to straight up.

uniform vec2 picture_px;
uniform vec3 to_sun;  // length 1

out vec4 colour;  // linear light

float hash(vec2 p) {
    vec3 q = fract(vec3(p.xyx) * 0.1031);
    q += dot(q, q.yzx + 33.33);
    return fract((q.x + q.y) * q.z);
}

float noise(vec2 p) {
    vec2 cell = floor(p), at = fract(p), smoothed = at * at * (3.0 - 2.0 * at);
    float low = mix(hash(cell), hash(cell + vec2(1, 0)), smoothed.x);
    float high = mix(hash(cell + vec2(0, 1)), hash(cell + vec2(1, 1)), smoothed.x);
    return mix(low, high, smoothed.y);
}

float clouds(vec2 p) {
    float sum = 0.0, strength = 0.5;
    for (int octave = 0; octave < 6; ++octave) {
        sum += strength * noise(p);
        p = mat2(1.6, 1.2, -1.2, 1.6) * p + 17.3;  // twice as fine, and turned: no lattice shows
        strength *= 0.5;
    }
    return sum;
}

void main() {
    float compass = (gl_FragCoord.x / picture_px.x - 0.5) * 6.2831853;
    float height = (gl_FragCoord.y / picture_px.y - 0.5) * 3.1415927;
    vec3 towards = vec3(cos(height) * sin(compass), sin(height), cos(height) * cos(compass));

    float up = max(towards.y, 0.0);
    vec3 zenith = vec3(0.10, 0.25, 0.62), horizon = vec3(0.66, 0.80, 0.98);
    vec3 sky = mix(horizon, zenith, 1.0 - exp(-3.2 * up));
    float near_sun = max(dot(towards, to_sun), 0.0);
    sky += vec3(1.0, 0.78, 0.5) * (0.22 * pow(near_sun, 8.0) + 0.7 * pow(near_sun, 90.0));

    // Clouds lie on a plane overhead, so that they crowd towards the horizon, and fade there into the haze.
    vec2 place = towards.xz / (up + 0.12);
    float cover = smoothstep(0.47, 0.74, clouds(1.3 * place + 4.0)) * smoothstep(0.0, 0.18, up);
    vec3 cloud = mix(vec3(0.78, 0.82, 0.9), vec3(1.35, 1.28, 1.18), smoothstep(0.4, 0.8, clouds(2.6 * place + 9.0)));
    sky = mix(sky, cloud, 0.8 * cover);

    // Hills far away, in two ranges; the farther one is nearly as pale as the air before it.
    float round = 3.1415927 * gl_FragCoord.x / picture_px.x;  // cos and sin of it twice: no seam
    vec2 ring = vec2(cos(2.0 * round), sin(2.0 * round));
    float far = 0.075 * clouds(5.0 * ring + 30.0) - 0.012, near = 0.06 * clouds(9.0 * ring + 50.0) - 0.022;
    float pixel = 3.1415927 / picture_px.y;
    sky = mix(vec3(0.52, 0.65, 0.80), sky, smoothstep(-pixel, pixel, height - far));
    sky = mix(vec3(0.38, 0.50, 0.57), sky, smoothstep(-pixel, pixel, height - near));
    colour = vec4(sky, 1.0);
}
