#version 330 core
// The twelve edges of a box as thin rectangles that face the eye: instance 0 to 11, vertex 0 to 3. No vertex data.

uniform mat4 view;
uniform mat4 projection;
uniform vec3 low_m;
uniform vec3 high_m;
uniform float near_m;
uniform vec2 picture_px;

const float kHalfWidth = 1.5;  // pixels, the soft rim included

out float off_axis;  // -1 to 1 across the line

void main() {
    // Edges 0-3 run along x, 4-7 along y, 8-11 along z; the two low bits pick one of the four.
    int axis = gl_InstanceID / 4, which = gl_InstanceID % 4;
    vec3 start = vec3(0.0), end;
    start[(axis + 1) % 3] = float(which & 1);
    start[(axis + 2) % 3] = float(which >> 1);
    end = start;
    end[axis] = 1.0;
    vec3 a = (view * vec4(mix(low_m, high_m, start), 1.0)).xyz;
    vec3 b = (view * vec4(mix(low_m, high_m, end), 1.0)).xyz;

    // Cut off what is behind the eye: it has no place in the picture.
    float limit = -1.01 * near_m;
    bool hidden = a.z > limit && b.z > limit;
    if (a.z > limit) a = mix(b, a, (limit - b.z) / (a.z - b.z));
    if (b.z > limit) b = mix(a, b, (limit - a.z) / (b.z - a.z));

    vec4 clip_a = projection * vec4(a, 1.0), clip_b = projection * vec4(b, 1.0);
    vec2 along = (clip_b.xy / clip_b.w - clip_a.xy / clip_a.w) * picture_px;
    vec2 across = vec2(-along.y, along.x) / max(length(along), 1e-6);
    off_axis = float(gl_VertexID & 1) * 2.0 - 1.0;
    vec4 clip = gl_VertexID < 2 ? clip_a : clip_b;
    clip.xy += across * off_axis * kHalfWidth * 2.0 / picture_px * clip.w;
    gl_Position = hidden ? vec4(2.0, 2.0, 2.0, 1.0) : clip;
}
