#version 330 core
// From light to a photograph.

uniform sampler2D scenery;    // what is solid
uniform sampler2D solid_depth;
uniform sampler2D fire;       // sprites, premultiplied
uniform sampler2D glare_map;  // the fire, blurred
uniform float glare;
uniform float exposure;
uniform vec2 picture_px;

out vec4 result;

// A number in [0, 1) for each pixel.
float grain(vec2 p) { return fract(52.9829189 * fract(dot(p, vec2(0.06711056, 0.00583715)))); }

// Sprites over what is solid.
vec3 light_at(ivec2 pixel) {
    pixel = clamp(pixel, ivec2(0), textureSize(fire, 0) - 1);
    vec4 sprites = texelFetch(fire, pixel, 0);
    return sprites.rgb + (1.0 - sprites.a) * texelFetch(scenery, pixel, 0).rgb;
}
float depth_at(ivec2 pixel) {
    float depth = texelFetch(solid_depth, clamp(pixel, ivec2(0), textureSize(fire, 0) - 1), 0).r;
    return 1.0 / (1.00001 - depth);  // nearly proportional to metres
}

//! [film]
// What the film shows of the light in a pixel.
vec3 exposed_at(ivec2 pixel, vec3 scattered) {
    vec3 light = mix(light_at(pixel), scattered, glare);
    // The filters over a film's three colours overlap: each sees a little of what belongs to the others. That
    // is why a flame's core is cream on a photograph, not lemon.
    light = mix(light, vec3(dot(light, vec3(0.2126, 0.7152, 0.0722))), 0.03);
    // Film runs out of grains: each colour comes near 1 and never reaches it. Red is first, then green; so
    // the deep orange of a black body turns yellow where flames overlap, as on a photograph.
    return 1.0 - exp(-exposure * light);
}

void main() {
    ivec2 pixel = ivec2(gl_FragCoord.xy);
    vec3 scattered = glare > 0.0 ? texture(glare_map, gl_FragCoord.xy / picture_px).rgb : vec3(0.0);
    vec3 exposed = exposed_at(pixel, scattered);
    // One ray a pixel leaves steps in the outlines of what is solid. There a pixel shares with its neighbours:
    // what the film shows of them, since in linear light a flame would outshine any log it shares a pixel with.
    float here = depth_at(pixel), jump = 0.0;
    for (int k = 0; k < 9; ++k)
        jump = max(jump, abs(depth_at(pixel + ivec2(k % 3, k / 3) - 1) - here) / here);
    if (jump > 0.03) {
        exposed *= 0.25;
        for (int k = 0; k < 4; ++k) {  // the corners weigh half as much as the sides
            int side = k % 2 == 0 ? 1 : -1;
            ivec2 beside = k < 2 ? ivec2(side, 0) : ivec2(0, side);
            ivec2 corner = ivec2(side, k < 2 ? 1 : -1);
            exposed += exposed_at(pixel + beside, scattered) / 8.0 + exposed_at(pixel + corner, scattered) / 16.0;
        }
    }
    // Half a step of noise before rounding to 8 bits: the dark keeps its shades without bands.
    vec3 noise = vec3(grain(gl_FragCoord.xy) - 0.5) / 255.0;
    result = vec4(exposed + noise * 2.0 * sqrt(exposed + 0.0001), 1.0);
}
//! [film]
