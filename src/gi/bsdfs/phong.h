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

    static vec3 f(const Surface& surface, const vec3& wo, const vec3& wi) {
        if (wi.z <= 0) return vec3(0);
        const float n = exponent(surface);
        return surface.tint() * (scale(n) * cos_power(Ggx::half(wo, wi), n));
    }

    static float pdf(const Surface& surface, const vec3& wo, const vec3& wi) {
        if (wi.z <= 0) return 0;
        const vec3 h = Ggx::half(wo, wi);
        const float n = exponent(surface);
        return (n + 1) / (2 * PI) * cos_power(h, n) / (4 * glm::dot(wo, h));
    }

    /// A half vector with density (n + 1) / (2 pi) cos^n, and wo mirrored at it.
    static std::optional<BsdfSample> sample(const Surface& surface, const vec3& wo, float, const vec2& u) {
        const float n = exponent(surface);
        const float sin2 = -std::expm1(2 / (n + 1) * std::log1p(-u.x)), sin = std::sqrt(sin2),
                    phi = 2 * PI * u.y;
        const vec3 h(sin * std::cos(phi), sin * std::sin(phi), safe_sqrt(1 - sin2));
        const vec3 wi = Ggx::mirrored(wo, h);
        if (wi.z <= 0 || glm::dot(wo, h) <= 0) return std::nullopt;
        const float pdf_wi = pdf(surface, wo, wi);
        if (pdf_wi <= 0) return std::nullopt;
        return BsdfSample{wi, f(surface, wo, wi) * wi.z / pdf_wi, pdf_wi, BRDF_GLOSSY};
    }

  private:
    static float exponent(const Surface& surface) {
        return std::max(2 / sqr(std::max(surface.roughness, Ggx::MIN_ALPHA)) - 2, 0.f);
    }
    /// cos^n of the angle of h, from its sine: near the normal the cosine has too few digits left for a large
    /// power.
    static float cos_power(const vec3& h, float n) {
        const float sin2 = h.x * h.x + h.y * h.y;
        return sin2 < 1 ? std::exp(n / 2 * std::log1p(-sin2)) : n == 0 ? 1.f : 0.f;
    }
    /// One over the lobe's albedo at normal incidence, the integral of cos^n(theta / 2) cos(theta) over the
    /// hemisphere.
    static float scale(float n) { return (n + 2) * (n + 4) / (8 * PI * (n + std::exp2(-n / 2))); }
};

}  // namespace etendue
