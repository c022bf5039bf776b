#version 330 core
// A round dot of one colour.

flat in float speed_m_per_s;

out vec4 colour;  // linear light: the framebuffer makes it sRGB

vec3 palette(float speed_m_per_s);  // palette.frag

void main() {
    vec2 off_centre = 2.0 * gl_PointCoord - 1.0;
    if (dot(off_centre, off_centre) > 1.0) discard;
    colour = vec4(palette(speed_m_per_s), 1.0);
}
