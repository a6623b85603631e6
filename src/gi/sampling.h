// Warps from the unit square to the domains of light transport, and the heuristics that combine two of them.
// Every warp is given with its density; `u` is uniform in [0, 1)^2.
#pragma once

#include "gi/math.h"

namespace etendue {

/// Uniform on the unit disc, equal areas and little distortion (Shirley and Chiu 1997). pdf_area = 1 / pi.
inline vec2 uniform_disc(const vec2& u) {
    const vec2 d = 2.f * u - 1.f;
    const bool wide = std::abs(d.x) > std::abs(d.y);
    const float r = wide ? d.x : d.y, other = wide ? d.y : d.x;
    if (r == 0) return d;
    // In the other half of the disc x and y change places, so that the angle is at most pi / 4 from an axis, where
    // few terms of sine and cosine are right to 4e-7.
    const float phi = (PI / 4) * (other / r), phi2 = phi * phi;
    const float sin = phi * (1 + phi2 * (-1 / 6.f + phi2 * (1 / 120.f - phi2 / 5040)));
    const float cos = 1 + phi2 * (-1 / 2.f + phi2 * (1 / 24.f + phi2 * (-1 / 720.f + phi2 / 40320)));
    return r * (wide ? vec2(cos, sin) : vec2(sin, cos));
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
inline vec2 uniform_triangle(const vec2& u) { return u - std::min(u.x, u.y) / 2; }

/// Weight of technique a, one sample each, by the balance heuristic (Veach 1997, 9.2.2). pdf_a > 0, one
/// measure for both.
inline float balance_heuristic(float pdf_a, float pdf_b) { return 1 / (1 + pdf_b / pdf_a); }

/// The same by the power heuristic with exponent 2 (Veach 1997, 9.2.3), safe from overflow.
inline float power_heuristic(float pdf_a, float pdf_b) { return 1 / (1 + sqr(pdf_b / pdf_a)); }

}  // namespace etendue
