#version 330 core
// What light does where air and water meet, and on its way through water. The same formulas as in optics.h.

uniform bool use_schlick;  // the cheaper formula in place of the exact one

const float kWaterIndex = 1.333;

//! [fresnel]
// The part of unpolarised light that a smooth surface throws back. `index`: refractive index beyond the
// surface over the one before it; `cosine`: of the angle between ray and normal, before the surface.
float fresnel_exact(float cosine, float index) {
    float sine2_beyond = (1.0 - cosine * cosine) / (index * index);
    if (sine2_beyond >= 1.0) return 1.0;  // total reflection
    float beyond = sqrt(1.0 - sine2_beyond);
    float across = (cosine - index * beyond) / (cosine + index * beyond);  // amplitude, one polarisation
    float along = (index * cosine - beyond) / (index * cosine + beyond);   // and the other
    return 0.5 * (across * across + along * along);
}

// Schlick's approximation. Its angle is the one in the thinner medium, on whichever side the ray is.
float fresnel_schlick(float cosine, float index) {
    float head_on = (index - 1.0) / (index + 1.0);
    if (index < 1.0) {
        float sine2_beyond = (1.0 - cosine * cosine) / (index * index);
        if (sine2_beyond >= 1.0) return 1.0;
        cosine = sqrt(1.0 - sine2_beyond);
    }
    float missing = 1.0 - cosine, missing2 = missing * missing;
    return mix(missing2 * missing2 * missing, 1.0, head_on * head_on);
}
//! [fresnel]

float fresnel(float cosine, float index) {
    return use_schlick ? fresnel_schlick(cosine, index) : fresnel_exact(cosine, index);
}

//! [pane]
// The part of light that a clean pane of glass throws back: from its near face, and from its far face after
// going to and fro inside it.
float pane_reflection(float cosine) {
    float once = fresnel(cosine, 1.5);
    return 2.0 * once / (1.0 + once);
}
//! [pane]
