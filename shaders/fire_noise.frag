#version 330 core
// Smooth noise in space, for bark, earth and embers.

float lattice(vec3 p) {
    p = fract(p * vec3(0.1031, 0.1030, 0.0973));
    p += dot(p, p.yxz + 33.33);
    return fract((p.x + p.y) * p.z);
}

float noise(vec3 x) {
    vec3 cell = floor(x), f = fract(x);
    f = f * f * (3.0 - 2.0 * f);
    vec2 o = vec2(0.0, 1.0);
    vec4 near = vec4(lattice(cell), lattice(cell + o.yxx), lattice(cell + o.xyx), lattice(cell + o.yyx));
    vec4 far = vec4(lattice(cell + o.xxy), lattice(cell + o.yxy), lattice(cell + o.xyy), lattice(cell + o.yyy));
    vec4 along = mix(near, far, f.z);
    return mix(mix(along.x, along.y, f.x), mix(along.z, along.w, f.x), f.y);
}

float rough_noise(vec3 x) {
    return 0.5333 * noise(x) + 0.2667 * noise(2.03 * x) + 0.1333 * noise(4.1 * x) + 0.0667 * noise(8.3 * x);
}
