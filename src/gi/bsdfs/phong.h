// Blinn and Phong's lobe, f = C cos^n(theta_h), scaled so that it reflects all of the light that arrives
// along the normal and less from the side.
#pragma once

#include "gi/bsdf.h"
#include "gi/microfacet.h"

namespace etendue {

struct Phong : Bsdf {
    static constexpr std::string_view name = "phong";
    static constexpr std::string_view summary = "Blinn-Phong lobe, exponent 2 / roughness^2 - 2";
    static constexpr bool is_reciprocal = true;
    static constexpr MaterialType types[] = {
        {.name = "phong", .summary = summary, .order = 50, .match = {"phong"}},
    };

    static vec3 albedo(const Surface& surface) { return surface.tint(); }

    template <class F>
    static Vec3<F> f(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi) {
        const F n = exponent(surface);
        const F lobe = scale(n) * cos_power(half_vector(wo, wi), n);
        return select(wi.z > 0, surface.tint() * lobe, Vec3<F>(0));
    }

    template <class F>
    static F pdf(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi) {
        const Vec3<F> h = half_vector(wo, wi);
        const F n = exponent(surface);
        return select(wi.z > 0, (n + 1) / (2 * PI) * cos_power(h, n) / (4 * dot(wo, h)), F(0));
    }

    /// A half vector with density (n + 1) / (2 pi) cos^n, and wo mirrored at it.
    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>& surface, const Vec3<F>& wo, const F&,
                                  const Vec2<F>& u) {
        const F n = exponent(surface);
        const F sin2 = -expm1(2 / (n + 1) * log1p(-u.x)), sin = sqrt(sin2);
        F sin_phi, cos_phi;
        sin_cos_of_turns(u.y, sin_phi, cos_phi);
        const Vec3<F> h(sin * cos_phi, sin * sin_phi, safe_sqrt(1 - sin2));
        const Vec3<F> wi = mirrored(wo, h);
        const F pdf_wi = pdf(surface, wo, wi);
        return {wi.z > 0 && dot(wo, h) > 0 && pdf_wi > 0, wi, f(surface, wo, wi) * wi.z / pdf_wi, pdf_wi,
                BRDF_GLOSSY};
    }

  private:
    template <class F>
    static F exponent(const SurfaceOf<F>& surface) {
        return max(2 / sqr(max(surface.roughness, F(MIN_ALPHA))) - 2, F(0));
    }
    /// cos^n of the angle of h, from its sine: near the normal the cosine has too few digits left for a large
    /// power.
    template <class V, class F>
    static F cos_power(const V& h, const F& n) {
        const F sin2 = h.x * h.x + h.y * h.y;
        const F power = exp(n * 0.5f * log1p(-min(sin2, F(ONE_MINUS_EPSILON))));
        return select(sin2 < 1 || n == 0, power, F(0));
    }
    /// One over the lobe's albedo at normal incidence, the integral of cos^n(theta / 2) cos(theta) over the
    /// hemisphere.
    template <class F>
    static F scale(const F& n) {
        return (n + 2) * (n + 4) / (8 * PI * (n + exp2(n * -0.5f)));
    }
};

}  // namespace etendue
