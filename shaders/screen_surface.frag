#version 330 core
// From depths to a surface: the normal follows from the depths of the neighbouring pixels.

uniform sampler2D depth_m;
uniform mat4 projection;
uniform mat4 camera_to_world;
uniform float narrow_m;

layout(location = 0) out vec4 surface;  // normal in world coordinates, distance from the eye in m

vec3 seen_point(ivec2 texel) {
    vec2 size = vec2(textureSize(depth_m, 0));
    float depth = texelFetch(depth_m, clamp(texel, ivec2(0), ivec2(size) - 1), 0).r;
    vec2 in_picture = 2.0 * (vec2(texel) + 0.5) / size - 1.0 + projection[2].xy;
    return depth * vec3(in_picture / vec2(projection[0][0], projection[1][1]), -1.0);
}

// Along one axis, from the side that is more likely the same surface: the one with the smaller step in depth.
vec3 slope(ivec2 texel, ivec2 along, vec3 here) {
    vec3 low = seen_point(texel - along), high = seen_point(texel + along);
    bool low_good = low.z < 0.0, high_good = high.z < 0.0;
    if (!high_good || (low_good && abs(here.z - low.z) < abs(high.z - here.z))) return here - low;
    return high - here;
}

void main() {
    ivec2 texel = ivec2(gl_FragCoord.xy);
    vec3 here = seen_point(texel);
    if (here.z == 0.0) {
        surface = vec4(0.0);
        return;
    }
    vec3 normal = normalize(cross(slope(texel, ivec2(1, 0), here), slope(texel, ivec2(0, 1), here)));
    surface = vec4(mat3(camera_to_world) * normal, length(here));
}
