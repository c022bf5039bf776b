#version 330 core
// The rectangle of the picture that one sphere covers. Four vertices, one sphere an instance.

layout(location = 0) in vec4 position_m;        // xyz; w is not used
layout(location = 1) in vec4 velocity_m_per_s;  // xyz; w is not used

uniform mat4 view;
uniform mat4 projection;
uniform float radius_m;
uniform float near_m;

flat out vec3 centre_m;  // of the sphere, in camera coordinates
flat out float speed_m_per_s;
out vec3 ray;            // from the eye through this corner, on the plane z = -1

//! [silhouette]
// Where the two tangents from the eye to a circle cross the line depth = 1. The circle's centre is (x, depth).
vec2 silhouette(float x, float depth) {
    float tangent = sqrt(x * x + depth * depth - radius_m * radius_m);
    return vec2((x * tangent - depth * radius_m) / (depth * tangent + x * radius_m),
                (x * tangent + depth * radius_m) / (depth * tangent - x * radius_m));
}
//! [silhouette]

void main() {
    centre_m = (view * vec4(position_m.xyz, 1.0)).xyz;
    speed_m_per_s = length(velocity_m_per_s.xyz);

    //! [rectangle]
    // Half the picture on the plane z = -1.
    vec2 half_size = 1.0 / vec2(projection[0][0], projection[1][1]);
    float depth = -centre_m.z;
    vec2 low = -half_size, high = half_size;
    if (depth > radius_m + near_m) {
        vec2 horizontal = silhouette(centre_m.x, depth), vertical = silhouette(centre_m.y, depth);
        low = vec2(horizontal.x, vertical.x);
        high = vec2(horizontal.y, vertical.y);
    }
    //! [rectangle]
    // A sphere that reaches through the eye's plane has no such tangents: it keeps the whole picture. Few do,
    // since only those stay that touch all four sides of the view.
    vec2 outside = (abs(centre_m.xy) - half_size * depth) / sqrt(1.0 + half_size * half_size);
    bool visible = depth + radius_m > near_m && max(outside.x, outside.y) < radius_m;

    vec2 corner = vec2(gl_VertexID & 1, gl_VertexID >> 1);
    ray = vec3(mix(low, high, corner), -1.0);
    // w = 1: the rectangle lies in the picture's plane, so `ray` is interpolated without perspective.
    gl_Position = visible ? vec4(ray.xy / half_size, 0.0, 1.0) : vec4(2.0, 2.0, 2.0, 1.0);
}
