// A diffuse base under a dielectric coat: GGX reflection and Lambert, mixed by the Fresnel reflectance F of
// the coat at wo,
//     f = F tint D G / (4 cos cos) + (1 - F) albedo / pi.
// F also is the probability of sampling the coat, and the pdf mixes the two pdfs alike.  As F is taken at wo
// alone, the mixture is not reciprocal; it keeps the exercise's pictures.
#pragma once

#include "gi/bsdf.h"
#include "gi/fresnel.h"
#include "gi/microfacet.h"

namespace etendue {

struct LayeredGgx : Bsdf {
    static constexpr std::string_view name = "layered_ggx";
    static constexpr std::string_view summary =
        "diffuse base under a dielectric GGX coat, mixed by Fresnel at wo";
    static constexpr MaterialType types[] = {
        {.name = "layered_ggx", .summary = summary, .order = 20, .match = {"layered_ggx"}, .ior = 1.3f},
        {.name = "plastic", .summary = "as layered_ggx", .order = 70, .match = {"plastic"}, .ior = 1.3f},
        {.name = "default",
         .summary = "as layered_ggx, where no other type matches",
         .order = 1000,
         .ior = 1.3f},
    };

    static vec3 albedo(const Surface& surface) {
        const float coat = fresnel_dielectric(1, surface.ior);
        return coat * surface.tint() + (1 - coat) * surface.albedo;
    }

    static vec3 f(const Surface& surface, const vec3& wo, const vec3& wi) {
        if (wi.z <= 0) return vec3(0);
        const float coat = fresnel_dielectric(wo.z, surface.ior);
        return coat * Ggx(surface.roughness).reflection(wo, wi) * surface.tint() +
               (1 - coat) * INV_PI * surface.albedo;
    }

    static float pdf(const Surface& surface, const vec3& wo, const vec3& wi) {
        if (wi.z <= 0) return 0;
        const float coat = fresnel_dielectric(wo.z, surface.ior);
        return coat * Ggx(surface.roughness).reflection_pdf(wo, wi) +
               (1 - coat) * cosine_hemisphere_pdf(wi.z);
    }

    static std::optional<BsdfSample> sample(const Surface& surface, const vec3& wo, float lobe,
                                            const vec2& u) {
        const Ggx ggx(surface.roughness);
        const bool on_coat = lobe < fresnel_dielectric(wo.z, surface.ior);
        const vec3 wi = on_coat ? Ggx::mirrored(wo, ggx.sample_visible(wo, u)) : cosine_hemisphere(u);
        const float pdf_wi = pdf(surface, wo, wi);
        if (pdf_wi <= 0) return std::nullopt;
        const uint8_t type = on_coat ? BRDF_GLOSSY : BRDF_DIFFUSE;
        return BsdfSample{wi, f(surface, wo, wi) * wi.z / pdf_wi, pdf_wi, type};
    }
};

}  // namespace etendue
