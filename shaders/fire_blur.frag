#version 330 core
// One direction of a Gaussian blur, 17 samples; with a step of 0, the mean of the pixels that one covers.

uniform sampler2D source;
uniform vec2 step_uv;
uniform vec2 target_px;

out vec4 result;

void main() {
    vec2 uv = gl_FragCoord.xy / target_px;
    if (step_uv == vec2(0.0)) {
        vec4 sum = vec4(0.0);
        for (int j = 0; j < 4; ++j)
            for (int i = 0; i < 4; ++i)
                sum += texture(source, uv + (vec2(i, j) - 1.5) * 0.25 / target_px);
        result = vec4(min(sum.rgb / 16.0, vec3(30000.0)), 1.0);  // a 16-bit float ends at 65504
        return;
    }
    vec4 sum = vec4(0.0);
    float weights = 0.0;
    for (int k = -8; k <= 8; ++k) {
        float weight = exp(-float(k * k) / 16.0);  // 0.02 at the last sample: no edge
        sum += weight * texture(source, uv + float(k) * step_uv);
        weights += weight;
    }
    result = sum / weights;
}
