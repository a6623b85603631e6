// The GGX distribution of microfacet normals, isotropic, sampled by the normals that are visible.
// Local frame, z = macroscopic normal; `wo.z` > 0 throughout (Walter et al. 2007; Heitz 2014).
#pragma once

#include "gi/sampling.h"

namespace etendue {

/// Below this alpha a lobe is narrower than float directions resolve.
inline constexpr float MIN_ALPHA = 1e-3f;

template <class F>
class Ggx {
  public:
    using V = Vec3<F>;

    explicit Ggx(const F& alpha) : alpha_(max(alpha, F(MIN_ALPHA))), alpha2_(sqr(alpha_)) {}

    /// Density of normals along h, of any length, per projected area. Written in sin^2 = x^2 + y^2, which
    /// keeps narrow lobes' digits.
    F D(const V& h) const {
        const F xy = h.x * h.x + h.y * h.y, z2 = h.z * h.z;
        const F length2_over_d = (xy + z2) / (xy + alpha2_ * z2);
        return alpha2_ * INV_PI * sqr(length2_over_d);
    }

    /// Smith's masking of the side of `w`.
    F G1(const V& w) const { return 2 * abs(w.z) / (abs(w.z) + root(w)); }

    /// Smith's masking and shadowing, correlated by height.
    F G2(const V& wo, const V& wi) const {
        const F o = abs(wo.z), i = abs(wi.z);
        return 2 * o * i / (i * root(wo) + o * root(wi));
    }

    /// Reflectance but for Fresnel: D G2 / (4 cos cos).
    F reflection(const V& wo, const V& wi) const {
        const F o = wo.z, i = wi.z;
        return D(wo + wi) / (2 * (i * root(wo) + o * root(wi)));
    }

    /// Solid-angle pdf of `wi` mirrored at a visible normal: D G1(wo) / (4 cos_o). The Jacobian of mirroring,
    /// 1 / (4 wo.h), cancels the cosine of the visible normals' own pdf.
    F reflection_pdf(const V& wo, const V& wi) const { return D(wo + wi) / (2 * (wo.z + root(wo))); }

    /// A normal visible from wo: in the frame where GGX is a hemisphere, a uniform point on the cap that
    /// reflects towards the upper side (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical
    /// Caps").
    V sample_visible(const V& wo, const Vec2<F>& u) const {
        const V w = normalize(V(alpha_ * wo.x, alpha_ * wo.y, wo.z));
        const V cap = direction_at((1 - u.y) * (1 + w.z) - w.z, u.x);
        const V h = cap + w;
        return normalize(V(alpha_ * h.x, alpha_ * h.y, max(h.z, F(0))));
    }

  private:
    /// sqrt(cos^2 + alpha^2 sin^2), which is cos (1 + 2 Lambda).
    F root(const V& w) const { return sqrt(w.z * w.z + alpha2_ * (w.x * w.x + w.y * w.y)); }

    F alpha_, alpha2_;
};

template <class V>
V half_vector(const V& wo, const V& wi) {
    return normalize(wo + wi);
}
template <class V>
V mirrored(const V& wo, const V& h) {
    return 2 * dot(wo, h) * h - wo;
}

}  // namespace etendue
