#version 330 core
// Colour from speed: four colours of rising speed, mixed in linear light.

uniform vec3 palette_colour[4];      // linear light
uniform float palette_top_m_per_s;  // the speed of the last colour

//! [palette]
vec3 palette(float speed_m_per_s) {
    float x = 3.0 * clamp(speed_m_per_s / palette_top_m_per_s, 0.0, 1.0);
    int k = min(int(x), 2);
    return mix(palette_colour[k], palette_colour[k + 1], x - float(k));
}
//! [palette]
