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
        return wi.z > 0 ? f(surface, wo, wi, fresnel_dielectric(wo.z, surface.ior)) : vec3(0);
    }

    static float pdf(const Surface& surface, const vec3& wo, const vec3& wi) {
        return wi.z > 0 ? pdf(surface, wo, wi, fresnel_dielectric(wo.z, surface.ior)) : 0;
    }

    static std::optional<BsdfSample> sample(const Surface& surface, const vec3& wo, float lobe,
                                            const vec2& u) {
        const float coat = fresnel_dielectric(wo.z, surface.ior);
        const bool on_coat = lobe < coat;
        const vec3 wi =
            on_coat ? Ggx::mirrored(wo, Ggx(surface.roughness).sample_visible(wo, u)) : cosine_hemisphere(u);
        const float pdf_wi = wi.z > 0 ? pdf(surface, wo, wi, coat) : 0;
        if (pdf_wi <= 0) return std::nullopt;
        const uint8_t type = on_coat ? BRDF_GLOSSY : BRDF_DIFFUSE;
        return BsdfSample{wi, f(surface, wo, wi, coat) * wi.z / pdf_wi, pdf_wi, type};
    }

  private:
    // Above the surface, with the reflectance of the coat at wo.
    static vec3 f(const Surface& surface, const vec3& wo, const vec3& wi, float coat) {
        return coat * Ggx(surface.roughness).reflection(wo, wi) * surface.tint() +
               (1 - coat) * INV_PI * surface.albedo;
    }
    static float pdf(const Surface& surface, const vec3& wo, const vec3& wi, float coat) {
        return coat * Ggx(surface.roughness).reflection_pdf(wo, wi) +
               (1 - coat) * cosine_hemisphere_pdf(wi.z);
    }
};

}  // namespace etendue
