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

    static vec3 f(const Surface& surface, const vec3& wo, const vec3& wi) {
        if (wi.z <= 0) return vec3(0);
        const float n = exponent(surface);
        return surface.tint() * (scale(n) * std::pow(Ggx::half(wo, wi).z, n));
    }

    static float pdf(const Surface& surface, const vec3& wo, const vec3& wi) {
        if (wi.z <= 0) return 0;
        const vec3 h = Ggx::half(wo, wi);
        return half_pdf(exponent(surface), h.z) / (4 * glm::dot(wo, h));
    }

    /// A half vector with density (n + 1) / (2 pi) cos^n, and wo mirrored at it.
    static std::optional<BsdfSample> sample(const Surface& surface, const vec3& wo, float, const vec2& u) {
        const float n = exponent(surface);
        const vec3 h = direction_at(std::pow(1 - u.x, 1 / (n + 1)), 2 * PI * u.y);
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
    static float half_pdf(float n, float cos_h) { return (n + 1) / (2 * PI) * std::pow(cos_h, n); }
    /// One over the lobe's albedo at normal incidence, the integral of cos^n(theta / 2) cos(theta) over the
    /// hemisphere.
    static float scale(float n) { return (n + 2) * (n + 4) / (8 * PI * (n + std::exp2(-n / 2))); }
};

}  // namespace etendue
