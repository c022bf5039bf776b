#version 330 core
// Ambient occlusion from the depth map: a surface with others close in front of it gets less of the light
// that comes from all around.

uniform sampler2D depth_map;
uniform mat4 projection;
uniform float occlusion_m;  // surfaces farther than this from each other do not matter; 0: none do

// The camera-space point seen at a texel of the depth map, or the origin where there is none.
vec3 seen_point(ivec2 texel) {
    float depth = texelFetch(depth_map, texel, 0).r;
    if (depth == 1.0) return vec3(0.0);
    float t = projection[3][2] / (projection[2][2] + 2.0 * depth - 1.0);
    vec2 in_picture = 2.0 * (vec2(texel) + 0.5) / vec2(textureSize(depth_map, 0)) - 1.0;
    return t * vec3(in_picture / vec2(projection[0][0], projection[1][1]), -1.0);
}

// The part of the light from all around that arrives at camera-space point p. It looks at a few points on a
// spiral around p, turned by `turn` (0 to 1), so that neighbouring samples look at different ones.
float openness(vec3 p, vec3 normal, float turn) {
    if (occlusion_m == 0.0) return 1.0;
    const int kPoints = 6;
    const float kGoldenAngle = 2.3999632, kFullAngle = 6.2831853;  // radians
    const float kAlmostLevel = 0.15;  // sine: what is lower over the surface is the surface's own neighbour
    const float kStrength = 2.1;      // chosen by eye

    vec2 size = vec2(textureSize(depth_map, 0));
    vec2 scale = 0.5 * size * vec2(projection[0][0], projection[1][1]) / -p.z;  // texels per metre
    float kept_off = 0.0;
    for (int k = 0; k < kPoints; ++k) {
        float angle = kFullAngle * turn + kGoldenAngle * float(k);
        float distance_m = occlusion_m * (float(k) + 0.5 + 0.5 * turn) / float(kPoints);
        vec2 place = 0.5 * size + scale * (p.xy + distance_m * vec2(cos(angle), sin(angle)));
        vec3 q = seen_point(ivec2(clamp(place, vec2(0.0), size - 1.0)));
        vec3 to_q = q - p;
        float near = 1.0 - dot(to_q, to_q) / (occlusion_m * occlusion_m);
        if (q.z < 0.0 && near > 0.0) {
            float sine = dot(to_q, normal) / max(length(to_q), 1e-6);
            kept_off += near * max(0.0, sine - kAlmostLevel);
        }
    }
    return max(0.0, 1.0 - kStrength * kept_off / float(kPoints));
}
