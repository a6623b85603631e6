// The GGX distribution of microfacet normals, isotropic, sampled by the normals that are visible.
// Local frame, z = macroscopic normal; `wo.z` > 0 throughout (Walter et al. 2007; Heitz 2014).
#pragma once

#include "gi/sampling.h"

namespace etendue {

class Ggx {
  public:
    /// Below this a lobe is narrower than float directions resolve.
    static constexpr float MIN_ALPHA = 1e-3f;

    explicit Ggx(float alpha)
        : alpha2_(sqr(std::max(alpha, MIN_ALPHA))), alpha_(std::max(alpha, MIN_ALPHA)) {}

    /// Density of normals along h, of any length, per projected area. Written in sin^2 = x^2 + y^2, which
    /// keeps narrow lobes' digits.
    float D(const vec3& h) const {
        const float xy = h.x * h.x + h.y * h.y, z2 = h.z * h.z;
        const float length2_over_d = (xy + z2) / (xy + alpha2_ * z2);
        return alpha2_ * INV_PI * sqr(length2_over_d);
    }

    /// Smith's masking of the side of `w`.
    float G1(const vec3& w) const { return 2 * std::abs(w.z) / (std::abs(w.z) + root(w)); }

    /// Smith's masking and shadowing, correlated by height.
    float G2(const vec3& wo, const vec3& wi) const {
        const float o = std::abs(wo.z), i = std::abs(wi.z);
        return 2 * o * i / (i * root(wo) + o * root(wi));
    }

    /// Reflectance but for Fresnel: D G2 / (4 cos cos).
    float reflection(const vec3& wo, const vec3& wi) const {
        const float o = wo.z, i = wi.z;
        return D(wo + wi) / (2 * (i * root(wo) + o * root(wi)));
    }

    /// Solid-angle pdf of `wi` mirrored at a visible normal: D G1(wo) / (4 cos_o). The Jacobian of mirroring,
    /// 1 / (4 wo.h), cancels the cosine of the visible normals' own pdf.
    float reflection_pdf(const vec3& wo, const vec3& wi) const {
        return D(wo + wi) / (2 * (wo.z + root(wo)));
    }

    /// A normal visible from wo: in the frame where GGX is a hemisphere, a uniform point on the cap that
    /// reflects towards the upper side (Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical
    /// Caps").
    vec3 sample_visible(const vec3& wo, const vec2& u) const {
        const vec3 w = glm::normalize(vec3(alpha_ * wo.x, alpha_ * wo.y, wo.z));
        const vec3 cap = direction_at((1 - u.y) * (1 + w.z) - w.z, 2 * PI * u.x);
        const vec3 h = cap + w;
        return glm::normalize(vec3(alpha_ * h.x, alpha_ * h.y, std::max(h.z, 0.f)));
    }

    static vec3 half(const vec3& wo, const vec3& wi) { return glm::normalize(wo + wi); }
    static vec3 mirrored(const vec3& wo, const vec3& h) { return 2 * glm::dot(wo, h) * h - wo; }

  private:
    /// sqrt(cos^2 + alpha^2 sin^2), which is cos (1 + 2 Lambda).
    float root(const vec3& w) const { return std::sqrt(w.z * w.z + alpha2_ * (w.x * w.x + w.y * w.y)); }

    float alpha2_, alpha_;
};

}  // namespace etendue
