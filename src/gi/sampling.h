// Warps from the unit square to the domains of light transport, and the heuristics that combine two of them.
// Every warp is given with its density; `u` is uniform in [0, 1)^2.
#pragma once

#include "gi/math.h"

namespace etendue {

/// Uniform on the unit disc, equal areas and little distortion (Shirley and Chiu 1997). pdf_area = 1 / pi.
template <class V2, class F = NumberOf<V2>>
V2 uniform_disc(const V2& u) {
    const F x = 2 * u.x - 1, y = 2 * u.y - 1;
    const Mask<F> wide = abs(x) > abs(y);
    const F r = select(wide, x, y), other = select(wide, y, x);
    // In the other half of the disc x and y change places, so that the angle is at most pi / 4 from an axis, where
    // few terms of sine and cosine are right to 4e-7. In the centre there is no angle.
    const F phi = (PI / 4) * (other / select(r == 0, F(1), r)), phi2 = phi * phi;
    const F sin = phi * (1 + phi2 * (-1 / 6.f + phi2 * (1 / 120.f - phi2 * (1 / 5040.f))));
    const F cos = 1 + phi2 * (-1 / 2.f + phi2 * (1 / 24.f + phi2 * (-1 / 720.f + phi2 * (1 / 40320.f))));
    return {r * select(wide, cos, sin), r * select(wide, sin, cos)};
}

/// Cosine-weighted on the hemisphere around +z (Malley's method). pdf = cosine_hemisphere_pdf(z).
template <class V2, class F = NumberOf<V2>>
Vec3<F> cosine_hemisphere(const V2& u) {
    const V2 d = uniform_disc(u);
    return {d.x, d.y, safe_sqrt(1 - d.x * d.x - d.y * d.y)};
}
template <class F>
F cosine_hemisphere_pdf(const F& cos_theta) {
    return max(cos_theta, F(0)) * INV_PI;
}

/// The unit vector of this height, and this many turns around the z axis, in [0, 1).
template <class F>
Vec3<F> direction_at(const F& z, const F& turns) {
    const F r = safe_sqrt(1 - z * z);
    F sin, cos;
    sin_cos_of_turns(turns, sin, cos);
    return {r * cos, r * sin, z};
}

/// Uniform on the hemisphere around +z. pdf = 1 / (2 pi).
inline vec3 uniform_hemisphere(const vec2& u) { return direction_at(u.x, u.y); }
inline constexpr float UNIFORM_HEMISPHERE_PDF = INV_PI / 2;

/// Uniform on the sphere. pdf = 1 / (4 pi).
template <class V2>
Vec3<NumberOf<V2>> uniform_sphere(const V2& u) {
    return direction_at(1 - 2 * u.x, u.y);
}
inline constexpr float UNIFORM_SPHERE_PDF = INV_PI / 4;

/// Barycentrics (b1, b2) uniform over a triangle: the square folded along its diagonal, which keeps
/// stratified points stratified (Heitz 2019, "A Low-Distortion Map Between Triangle and Square").
template <class V2>
V2 uniform_triangle(const V2& u) {
    const auto half = min(u.x, u.y) * 0.5f;
    return {u.x - half, u.y - half};
}

/// Weight of technique a, one sample each, by the balance heuristic (Veach 1997, 9.2.2). pdf_a > 0, one
/// measure for both.
template <class F>
F balance_heuristic(const F& pdf_a, const F& pdf_b) {
    return 1 / (1 + pdf_b / pdf_a);
}

/// The same by the power heuristic with exponent 2 (Veach 1997, 9.2.3), safe from overflow.
template <class F>
F power_heuristic(const F& pdf_a, const F& pdf_b) {
    return 1 / (1 + sqr(pdf_b / pdf_a));
}

}  // namespace etendue
