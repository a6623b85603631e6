// Fresnel reflectance of unpolarised light (pbrt 4th ed., 9.3.5 and 9.3.6; Born and Wolf, 1.5 and 14.2).
#pragma once

#include "gi/math.h"

namespace etendue {

/// Reflectance at a smooth boundary between dielectrics. `cos_i` >= 0 on the side the light comes from, `eta`
/// the other side's index over this side's. 1 on total reflection.
template <class F>
F fresnel_dielectric(const F& cos_i, const F& eta) {
    const F sin2_t = (1 - cos_i * cos_i) / (eta * eta);
    const F cos_t = safe_sqrt(1 - sin2_t);
    const F parallel = (eta * cos_i - cos_t) / (eta * cos_i + cos_t);
    const F perpendicular = (cos_i - eta * cos_t) / (cos_i + eta * cos_t);
    return select(sin2_t >= 1, F(1), (parallel * parallel + perpendicular * perpendicular) * 0.5f);
}

/// Reflectance of a conductor of complex index eta + i k seen from air, at `cos_i` >= 0.
template <class F>
F fresnel_conductor(const F& cos_i, const F& eta, const F& k) {
    const F cos2 = cos_i * cos_i, sin2 = 1 - cos2;
    const F difference = eta * eta - k * k - sin2;
    const F a2_plus_b2 = sqrt(difference * difference + 4 * eta * eta * k * k);
    const F a = safe_sqrt((a2_plus_b2 + difference) * 0.5f);
    const F t1 = a2_plus_b2 + cos2, t2 = 2 * cos_i * a;
    const F perpendicular = (t1 - t2) / (t1 + t2);
    const F t3 = cos2 * a2_plus_b2 + sin2 * sin2, t4 = t2 * sin2;
    const F parallel = perpendicular * (t3 - t4) / (t3 + t4);
    return (perpendicular + parallel) * 0.5f;
}

/// The direction of `wo` (z >= 0) refracted through z = 0, along it on total reflection. `eta` as above.
template <class V, class F = NumberOf<V>>
V refract(const V& wo, const F& eta) {
    const F sin2_t = (1 - wo.z * wo.z) / (eta * eta);
    return V(-wo.x / eta, -wo.y / eta, -safe_sqrt(1 - sin2_t));
}

}  // namespace etendue
