// Numbers and vectors: the constants of radiometry, and the shading frame. What is a template is for floats and for
// Lanes, see gi/lanes.h.
#pragma once

#include <limits>

#include "gi/lanes.h"

namespace etendue {

inline constexpr float PI = 3.14159265358979323846f;
inline constexpr float INV_PI = 1 / PI;
inline constexpr float INFINITE = std::numeric_limits<float>::infinity();
// The largest float below one: random numbers live in [0, 1).
inline constexpr float ONE_MINUS_EPSILON = 0x1.fffffep-1f;

template <class F>
F sqr(const F& x) {
    return x * x;
}
template <class F>
F safe_sqrt(const F& x) {
    return sqrt(max(x, F(0)));
}
template <class V>
NumberOf<V> length2(const V& v) {
    return dot(v, v);
}
template <class V>
NumberOf<V> max_component(const V& v) {
    return max(v.x, max(v.y, v.z));
}
template <class V>
Mask<NumberOf<V>> is_black(const V& v) {
    return v.x == 0 && v.y == 0 && v.z == 0;
}

/// Relative luminance of linear sRGB (Rec. 709 primaries, D65).
inline float luminance(const vec3& rgb) { return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z; }

/// The angle of (x, y), as std::atan2 but a fifth of its time, off by up to 3e-7.
template <class F>
F fast_atan2(const F& y, const F& x) {
    const F ax = abs(x), ay = abs(y);
    const F larger = max(ax, ay);
    // In [0, 1], where this polynomial has the smallest largest error of its degree.
    const F a = select(larger > 0, min(ax, ay) / larger, F(0)), a2 = a * a;
    constexpr float c[] = {0.99999934f, -0.3332986f,  0.19946559f,  -0.13908596f,
                           0.09642113f, -0.05591121f, 0.021862205f, -0.0040543648f};
    F p = c[7];
    for (int i = 6; i >= 0; --i) p = p * a2 + c[i];
    F angle = a * p;
    angle = select(ay > ax, PI / 2 - angle, angle);
    angle = select(x < 0, PI - angle, angle);
    return copysign(angle, y);
}

/// Between a and b, by the share of b.
template <class T, class F>
T mixed(const T& a, const T& b, const F& share) {
    return a * (1 - share) + b * share;
}

/// Bound on the relative error of n float operations in a row (pbrt 4th ed., 6.8.1).
inline constexpr float error_bound(int n) {
    constexpr float half_ulp = std::numeric_limits<float>::epsilon() / 2;
    return n * half_ulp / (1 - n * half_ulp);
}

/// Sine and cosine of a number of turns, off by at most 1e-7 for one.
template <class F>
void sin_cos_of_turns(const F& turns, F& sine, F& cosine) {
    // By the nearest quarter turn, from which an angle is at most pi / 4, where few terms will do.
    const F nearest = floor(4 * turns + 0.5f);
    const F a = 2 * PI * (turns - 0.25f * nearest), a2 = a * a;
    const F sin_a = a * (1 + a2 * (-1 / 6.f + a2 * (1 / 120.f + a2 * (-1 / 5040.f + a2 * (1 / 362880.f)))));
    const F cos_a = 1 + a2 * (-1 / 2.f + a2 * (1 / 24.f + a2 * (-1 / 720.f + a2 * (1 / 40320.f))));
    const F quarter = nearest - 4 * floor(0.25f * nearest);
    const Mask<F> odd = quarter == 1 || quarter == 3;
    const F s = select(odd, cos_a, sin_a), c = select(odd, sin_a, cos_a);
    sine = select(quarter == 2 || quarter == 3, -s, s);
    cosine = select(quarter == 1 || quarter == 2, -c, c);
}

/// Right-handed orthonormal frame around a unit normal, which is its local z axis.
template <class F>
struct FrameOf {
    Vec3<F> s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    FrameOf() = default;

    /// Any frame with this normal, without branches (Duff et al. 2017, "Building an Orthonormal Basis,
    /// Revisited").
    explicit FrameOf(const Vec3<F>& normal) : n(normal) {
        const F sign = copysign(F(1), n.z);
        const F a = -1 / (sign + n.z);
        const F b = n.x * n.y * a;
        s = Vec3<F>(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        t = Vec3<F>(b, sign + n.y * n.y * a, -n.y);
    }

    Vec3<F> to_local(const Vec3<F>& v) const { return {dot(v, s), dot(v, t), dot(v, n)}; }
    Vec3<F> to_world(const Vec3<F>& v) const { return s * v.x + t * v.y + n * v.z; }
};
using Frame = FrameOf<float>;

}  // namespace etendue
