#version 330 core
// A soft rectangle that faces the eye, longer along its flight. Four vertices, one particle an instance.

layout(location = 0) in vec4 position_age;   // m, s
layout(location = 1) in vec4 velocity_life;  // m/s, s
layout(location = 2) in float gain;

uniform mat4 view;
uniform mat4 projection;
uniform vec2 radius_m;       // at birth and at death
uniform vec2 temperature_K;  // at birth and at death; 0: not a black body
uniform vec2 ramp_K;         // temperatures of the ramp's first and last texel
uniform vec2 fade;           // parts of the life
uniform float stretch_s;
uniform float light;
uniform vec3 colour;
uniform float opacity;
uniform int additive;
uniform sampler2D ramp;  // black body: colour of luminance 1, logarithm of the luminance

uniform vec3 sky_high;
uniform int light_count;
uniform vec4 light_at[4];  // position, size
uniform vec3 light_colour[4];

out vec2 place;                 // on the sprite, -1 to 1; y along the flight
flat out vec2 wisp;             // lower corner of this particle's wisp in the texture
flat out vec4 premultiplied;    // colour and alpha of the sprite's middle
flat out float depth_m;

//! [glow]
// What a black body of this temperature gives off. The luminance grows 170,000-fold from 1000 to 2000 K, so
// that a cooling flame ends by itself: nothing has to be faded out.
vec3 glow(float kelvin) {
    float along = (kelvin - ramp_K.x) / (ramp_K.y - ramp_K.x);
    vec4 body = texture(ramp, vec2((clamp(along, 0.0, 1.0) * 255.0 + 0.5) / 256.0, 0.5));
    return body.rgb * exp(body.a);
}
//! [glow]

// Smoke reflects the fire's light to all sides.
vec3 light_on_smoke(vec3 x) {
    vec3 sum = sky_high;
    for (int k = 0; k < light_count; ++k) {
        vec3 to_light = light_at[k].xyz - x;
        sum += light_colour[k] / (dot(to_light, to_light) + light_at[k].w * light_at[k].w);
    }
    return sum;
}

void main() {
    float age_s = position_age.w, life_s = velocity_life.w;
    vec4 centre = view * vec4(position_age.xyz, 1.0);
    depth_m = -centre.z;
    if (!(age_s >= 0.0 && age_s < life_s) || depth_m < 0.01) {
        gl_Position = vec4(2.0, 2.0, 2.0, 1.0);  // not born, dead, or behind the eye: outside the picture
        return;
    }
    float burnt = age_s / life_s;

    //! [stretch]
    // The velocity as the picture shows it; a sprite that flies towards the eye is not longer.
    vec3 velocity = (view * vec4(velocity_life.xyz, 0.0)).xyz;
    vec2 flight = velocity.xy - centre.xy / centre.z * velocity.z;
    float speed = length(flight);
    vec2 along = speed > 1e-4 ? flight / speed : vec2(0.0, 1.0);
    float radius = mix(radius_m.x, radius_m.y, burnt);
    float half_length = radius + 0.5 * stretch_s * speed;
    //! [stretch]
    place = 2.0 * vec2(gl_VertexID & 1, gl_VertexID >> 1) - 1.0;
    centre.xy += place.x * radius * vec2(along.y, -along.x) + place.y * half_length * along;
    gl_Position = projection * centre;

    // Every particle has its own wisp of the sixteen, for all its life: its life is its name.
    float name = fract(life_s * 7919.0);
    wisp = 0.25 * floor(vec2(fract(name * 16.0) * 4.0, name * 4.0));

    //! [sprite_light]
    // A longer sprite spreads the same light over more of the picture.
    float seen = gain * radius / half_length * smoothstep(0.0, fade.x, burnt) *
                 (1.0 - smoothstep(1.0 - fade.y, 1.0, burnt));
    if (additive == 1) {
        vec3 body = temperature_K.x > 0.0 ? glow(mix(temperature_K.x, temperature_K.y, burnt)) : vec3(1.0);
        premultiplied = vec4(seen * light * colour * body, 0.0);  // covers nothing
    } else {
        float alpha = clamp(seen * opacity, 0.0, 1.0);
        premultiplied = vec4(alpha * colour * light_on_smoke(position_age.xyz), alpha);
    }
    //! [sprite_light]
}
