#version 330 core
// A photon's light, spread over the texels around it. Wherever it lands, the weights add up to 1: none is lost.

flat in vec3 light;
flat in vec2 place_px;

out vec4 colour;

void main() {
    vec2 weight = max(vec2(0.0), 1.0 - abs(gl_FragCoord.xy - place_px) / 2.0) / 2.0;
    colour = vec4(light * weight.x * weight.y, 0.0);
}
