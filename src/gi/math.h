// Numbers and vectors: glm's types, the constants of radiometry, and the shading frame.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <limits>

namespace etendue {

using glm::vec2;
using glm::vec3;

inline constexpr float PI = 3.14159265358979323846f;
inline constexpr float INV_PI = 1 / PI;
inline constexpr float INFINITE = std::numeric_limits<float>::infinity();
// The largest float below one: random numbers live in [0, 1).
inline constexpr float ONE_MINUS_EPSILON = 0x1.fffffep-1f;

inline float sqr(float x) { return x * x; }
inline float length2(const vec3& v) { return glm::dot(v, v); }
inline float safe_sqrt(float x) { return std::sqrt(std::max(x, 0.f)); }
inline float max_component(const vec3& v) { return std::max(v.x, std::max(v.y, v.z)); }
inline bool is_black(const vec3& v) { return v.x == 0 && v.y == 0 && v.z == 0; }

/// Relative luminance of linear sRGB (Rec. 709 primaries, D65).
inline float luminance(const vec3& rgb) { return 0.2126f * rgb.x + 0.7152f * rgb.y + 0.0722f * rgb.z; }

/// The angle of (x, y), as std::atan2 but a fifth of its time, off by up to 3e-7.
inline float fast_atan2(float y, float x) {
    const float ax = std::abs(x), ay = std::abs(y);
    const float larger = std::max(ax, ay);
    // In [0, 1], where this polynomial has the smallest largest error of its degree.
    const float a = larger > 0 ? std::min(ax, ay) / larger : 0, a2 = a * a;
    constexpr float c[] = {0.99999934f, -0.3332986f,  0.19946559f,  -0.13908596f,
                           0.09642113f, -0.05591121f, 0.021862205f, -0.0040543648f};
    float p = c[7];
    for (int i = 6; i >= 0; --i) p = p * a2 + c[i];
    float angle = a * p;
    if (ay > ax) angle = PI / 2 - angle;
    if (x < 0) angle = PI - angle;
    return std::copysign(angle, y);
}

/// Bound on the relative error of n float operations in a row (pbrt 4th ed., 6.8.1).
inline constexpr float error_bound(int n) {
    constexpr float half_ulp = std::numeric_limits<float>::epsilon() / 2;
    return n * half_ulp / (1 - n * half_ulp);
}

/// Right-handed orthonormal frame around a unit normal, which is its local z axis.
struct Frame {
    vec3 s{1, 0, 0}, t{0, 1, 0}, n{0, 0, 1};

    Frame() = default;

    /// Any frame with this normal, without branches (Duff et al. 2017, "Building an Orthonormal Basis,
    /// Revisited").
    explicit Frame(const vec3& normal) : n(normal) {
        const float sign = std::copysign(1.f, n.z);
        const float a = -1 / (sign + n.z);
        const float b = n.x * n.y * a;
        s = vec3(1 + sign * n.x * n.x * a, sign * b, -sign * n.x);
        t = vec3(b, sign + n.y * n.y * a, -n.y);
    }

    vec3 to_local(const vec3& v) const { return {glm::dot(v, s), glm::dot(v, t), glm::dot(v, n)}; }
    vec3 to_world(const vec3& v) const { return s * v.x + t * v.y + n * v.z; }
};

}  // namespace etendue
