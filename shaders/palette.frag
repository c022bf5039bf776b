#version 330 core
// Colour from speed: four colours of rising speed, mixed in linear light.

uniform vec3 palette_colour[4];      // linear light
uniform float palette_top_m_per_s;  // the speed of the last colour

//! [palette]
vec3 palette(float speed_m_per_s) {
    // Written so that a speed that is not a number (no comparison with it is true) has the colour of rest.
    float x = speed_m_per_s > 0.0 ? 3.0 * min(speed_m_per_s / palette_top_m_per_s, 1.0) : 0.0;
    int k = min(int(x), 2);
    return mix(palette_colour[k], palette_colour[k + 1], x - float(k));
}
//! [palette]
