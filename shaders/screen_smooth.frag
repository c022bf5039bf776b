#version 330 core
// One direction of a filter that evens out the particles' spheres, and keeps the edge between a near and a far surface.

uniform sampler2D depth_m;   // in front of the eye's plane; 0: no water
uniform vec2 along;          // (1, 0) or (0, 1)
uniform float reach_m;       // of the filter
uniform float narrow_m;      // depths that differ by more belong to another surface
uniform float pixels_per_rad;

layout(location = 0) out vec4 smoothed_m;

//! [smooth]
void main() {
    ivec2 here = ivec2(gl_FragCoord.xy), size = textureSize(depth_m, 0);
    float mine = texelFetch(depth_m, here, 0).r;
    if (mine == 0.0) {
        smoothed_m = vec4(0.0);
        return;
    }
    int reach = clamp(int(reach_m * pixels_per_rad / mine), 1, 40);
    float sum = mine, weights = 1.0;
    for (int k = 1; k <= reach; ++k) {
        float weight = exp(-4.5 * float(k * k) / float(reach * reach));  // 3 standard deviations at the reach
        float low = texelFetch(depth_m, clamp(here - k * ivec2(along), ivec2(0), size - 1), 0).r;
        float high = texelFetch(depth_m, clamp(here + k * ivec2(along), ivec2(0), size - 1), 0).r;
        // Nearer ones belong to a surface in front: neither side counts, or the filter would lean. Farther ones and
        // holes count as if they lay just behind: so an edge keeps its place.
        if ((low > 0.0 && low < mine - narrow_m) || (high > 0.0 && high < mine - narrow_m)) continue;
        if (low == 0.0 || low > mine + narrow_m) low = mine + narrow_m;
        if (high == 0.0 || high > mine + narrow_m) high = mine + narrow_m;
        sum += weight * (low + high);
        weights += 2.0 * weight;
    }
    smoothed_m = vec4(sum / weights);
}
//! [smooth]
