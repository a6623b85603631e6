// Fresnel reflectance of unpolarised light (pbrt 4th ed., 9.3.5 and 9.3.6; Born and Wolf, 1.5 and 14.2).
#pragma once

#include <optional>

#include "gi/math.h"

namespace etendue {

/// Reflectance at a smooth boundary between dielectrics. `cos_i` >= 0 on the side the light comes from, `eta`
/// the other side's index over this side's. 1 on total reflection.
inline float fresnel_dielectric(float cos_i, float eta) {
    const float sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    if (sin2_t >= 1) return 1;
    const float cos_t = std::sqrt(1 - sin2_t);
    const float parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const float perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return (parallel * parallel + perpendicular * perpendicular) / 2;
}

/// Reflectance of a conductor of complex index eta + i k seen from air, at `cos_i` >= 0.
inline float fresnel_conductor(float cos_i, float eta, float k) {
    const float cos2 = cos_i * cos_i, sin2 = 1 - cos2;
    const float difference = eta * eta - k * k - sin2;
    const float a2_plus_b2 = std::sqrt(difference * difference + 4 * eta * eta * k * k);
    const float a = safe_sqrt((a2_plus_b2 + difference) / 2);
    const float t1 = a2_plus_b2 + cos2, t2 = 2 * cos_i * a;
    const float perpendicular = (t1 - t2) / (t1 + t2);
    const float t3 = cos2 * a2_plus_b2 + sin2 * sin2, t4 = t2 * sin2;
    const float parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return (perpendicular + parallel) / 2;
}

/// The direction of `wo` (z >= 0) refracted through z = 0; empty on total reflection. `eta` as above.
inline std::optional<vec3> refract(const vec3& wo, float eta) {
    const float sin2_t = (1 - wo.z * wo.z) / (eta * eta);
    if (sin2_t >= 1) return std::nullopt;
    return vec3(-wo.x / eta, -wo.y / eta, -std::sqrt(1 - sin2_t));
}

}  // namespace etendue
