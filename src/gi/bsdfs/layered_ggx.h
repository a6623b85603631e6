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
        const float coat = fresnel_dielectric(1.f, surface.ior);
        return coat * surface.tint() + (1 - coat) * surface.albedo;
    }

    template <class F>
    static F diffuse_share(const F& ior, const F& cos_o) {
        return 1 - fresnel_dielectric(cos_o, ior);
    }

    template <class F>
    static Vec3<F> f(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi) {
        return select(wi.z > 0, f(surface, wo, wi, fresnel_dielectric(wo.z, surface.ior)), Vec3<F>(0));
    }

    template <class F>
    static F pdf(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi) {
        return select(wi.z > 0, pdf(surface, wo, wi, fresnel_dielectric(wo.z, surface.ior)), F(0));
    }

    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>& surface, const Vec3<F>& wo, const F& lobe,
                                  const Vec2<F>& u) {
        const F coat = fresnel_dielectric(wo.z, surface.ior);
        const Mask<F> on_coat = lobe < coat;
        Vec3<F> wi = cosine_hemisphere(u);
        if (any(on_coat))
            wi = select(on_coat, mirrored(wo, Ggx<F>(surface.roughness).sample_visible(wo, u)), wi);
        const F pdf_wi = pdf(surface, wo, wi, coat);
        return {wi.z > 0 && pdf_wi > 0, wi, f(surface, wo, wi, coat) * wi.z / pdf_wi, pdf_wi,
                select(on_coat, F(BRDF_GLOSSY), F(BRDF_DIFFUSE))};
    }

  private:
    // Above the surface, with the reflectance of the coat at wo.
    template <class F>
    static Vec3<F> f(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi, const F& coat) {
        return coat * Ggx<F>(surface.roughness).reflection(wo, wi) * surface.tint() +
               (1 - coat) * INV_PI * surface.albedo;
    }
    template <class F>
    static F pdf(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi, const F& coat) {
        return coat * Ggx<F>(surface.roughness).reflection_pdf(wo, wi) +
               (1 - coat) * cosine_hemisphere_pdf(wi.z);
    }
};

}  // namespace etendue
