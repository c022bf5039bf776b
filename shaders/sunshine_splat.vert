#version 330 core
// Two points for each photon: one takes the light away from where it would have landed, one brings it where it lands.

uniform sampler2D landings;
uniform vec4 sunshine_m;
uniform vec2 map_px;
uniform vec3 absorption_per_m;

flat out vec3 light;
flat out vec2 place_px;

void main() {
    ivec2 size = textureSize(landings, 0);
    int photon = gl_VertexID / 2;
    vec2 texel = vec2(photon % size.x, photon / size.x) + 0.5;
    vec4 landing = texelFetch(landings, ivec2(texel), 0);
    vec2 straight = texel / vec2(size);
    bool arrives = (gl_VertexID & 1) == 1;
    vec2 place = arrives ? (landing.xy - sunshine_m.xy) / sunshine_m.zw : straight;
    float photons_per_px = float(size.x * size.y) / (map_px.x * map_px.y);
    light = (arrives ? landing.z * exp(-absorption_per_m * landing.w) : vec3(-1.0)) / photons_per_px;
    place_px = place * map_px;
    bool as_ever = landing.z == 1.0 && landing.w == 0.0;
    gl_Position = as_ever ? vec4(2.0, 2.0, 2.0, 1.0) : vec4(2.0 * place - 1.0, 0.0, 1.0);
    gl_PointSize = 6.0;
}
