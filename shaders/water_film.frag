#version 330 core
// From light to a picture: the sum of all samples, exposed, its highlights rolled off.

uniform sampler2D light_sum;
uniform float exposure;  // 1 / samples included

out vec4 colour;  // the framebuffer makes it sRGB

//! [film]
// A film's curve: dark tones hardly touched, highlights pressed together short of white, each channel by itself.
vec3 film(vec3 light) {
    const float kShoulder = 0.55;
    vec3 over = max(light - kShoulder, 0.0);
    return min(light, kShoulder) + (1.0 - kShoulder) * (1.0 - exp(-over / (1.0 - kShoulder)));
}
//! [film]

void main() { colour = vec4(film(exposure * texelFetch(light_sum, ivec2(gl_FragCoord.xy), 0).rgb), 1.0); }
