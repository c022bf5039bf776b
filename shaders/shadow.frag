#version 330 core
// Depth of a sphere seen from the light; no colour.

uniform float radius_depth;  // the radius in units of depth

void main() {
    vec2 off_centre = 2.0 * gl_PointCoord - 1.0;
    float r2 = dot(off_centre, off_centre);
    if (r2 > 1.0) discard;
    gl_FragDepth = gl_FragCoord.z - radius_depth * sqrt(1.0 - r2);
}
