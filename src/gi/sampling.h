// Warps from the unit square to the domains of light transport, and the heuristics that combine two of them.
// Every warp is given with its density; `u` is uniform in [0, 1)^2.
#pragma once

#include "gi/math.h"

namespace etendue {

/// Uniform on the unit disc, equal areas and little distortion (Shirley and Chiu 1997). pdf_area = 1 / pi.
inline vec2 uniform_disc(const vec2& u) {
    const vec2 d = 2.f * u - 1.f;
    if (d.x == 0 && d.y == 0) return d;
    const bool wide = std::abs(d.x) > std::abs(d.y);
    const float r = wide ? d.x : d.y;
    const float phi = wide ? (PI / 4) * (d.y / d.x) : (PI / 2) - (PI / 4) * (d.x / d.y);
    return r * vec2(std::cos(phi), std::sin(phi));
}

/// Cosine-weighted on the hemisphere around +z (Malley's method). pdf = cosine_hemisphere_pdf(z).
inline vec3 cosine_hemisphere(const vec2& u) {
    const vec2 d = uniform_disc(u);
    return {d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)};
}
inline float cosine_hemisphere_pdf(float cos_theta) { return std::max(cos_theta, 0.f) * INV_PI; }

/// The unit vector of this height and azimuth.
inline vec3 direction_at(float z, float phi) {
    const float r = safe_sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

/// Uniform on the hemisphere around +z. pdf = 1 / (2 pi).
inline vec3 uniform_hemisphere(const vec2& u) { return direction_at(u.x, 2 * PI * u.y); }
inline constexpr float UNIFORM_HEMISPHERE_PDF = INV_PI / 2;

/// Uniform on the sphere. pdf = 1 / (4 pi).
inline vec3 uniform_sphere(const vec2& u) { return direction_at(1 - 2 * u.x, 2 * PI * u.y); }
inline constexpr float UNIFORM_SPHERE_PDF = INV_PI / 4;

/// Barycentrics (b1, b2) uniform over a triangle: the square folded along its diagonal, which keeps
/// stratified points stratified (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
inline vec2 uniform_triangle(const vec2& u) {
    if (u.y > u.x) {
        const float x = u.x / 2;
        return {x, u.y - x};
    }
    const float y = u.y / 2;
    return {u.x - y, y};
}

/// Weight of technique a, one sample each, by the balance heuristic (Veach 1997, 9.2.2). pdf_a > 0, one
/// measure for both.
inline float balance_heuristic(float pdf_a, float pdf_b) { return 1 / (1 + pdf_b / pdf_a); }

/// The same by the power heuristic with exponent 2 (Veach 1997, 9.2.3), safe from overflow.
inline float power_heuristic(float pdf_a, float pdf_b) { return 1 / (1 + sqr(pdf_b / pdf_a)); }

}  // namespace etendue
