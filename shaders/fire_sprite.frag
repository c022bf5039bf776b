#version 330 core
// A spot without an edge, torn into wisps.

in vec2 place;
flat in vec2 wisp;
flat in vec4 premultiplied;
flat in float depth_m;

uniform mat4 projection;
uniform sampler2D wisp_map;
uniform sampler2D solid_depth;  // of what is solid behind or before the sprite
uniform float wisps;
uniform float softness_m;

out vec4 result;

//! [soft_spot]
void main() {
    float inside = 1.0 - dot(place, place);
    if (inside <= 0.0) discard;
    float spot = inside * inside;  // value and slope are 0 at the rim: no edge is seen
    // Half a texel stays free on each side: a wisp never bleeds into its neighbour.
    vec2 uv = wisp + 0.25 * (0.5 + 0.48 * place);
    spot *= mix(1.0, texture(wisp_map, uv).r, wisps);

    // Where the sprite meets something solid it fades, instead of being cut along a line.
    float z = 2.0 * texelFetch(solid_depth, ivec2(gl_FragCoord.xy), 0).r - 1.0;
    float solid_m = projection[3][2] / (z + projection[2][2]);
    float free = clamp((solid_m - depth_m) / softness_m, 0.0, 1.0);
    result = spot * free * premultiplied;
}
//! [soft_spot]
