// Lambertian transmission: f = albedo / pi on the far side, as through thin cloth or paper.
#pragma once

#include "gi/bsdf.h"

namespace etendue {

struct Translucent : Bsdf {
    static constexpr std::string_view name = "translucent";
    static constexpr std::string_view summary = "Lambertian transmission";
    static constexpr MaterialType types[] = {
        {.name = "translucent", .summary = summary, .order = 80, .match = {"translucent"}, .ior = 1.52f},
    };

    template <class F>
    static Vec3<F> f(const SurfaceOf<F>& surface, const Vec3<F>&, const Vec3<F>& wi) {
        return select(wi.z < 0, surface.albedo * F(INV_PI), Vec3<F>(0));
    }

    template <class F>
    static F pdf(const SurfaceOf<F>&, const Vec3<F>&, const Vec3<F>& wi) {
        return cosine_hemisphere_pdf(-wi.z);
    }

    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>& surface, const Vec3<F>&, const F&, const Vec2<F>& u) {
        const Vec3<F> wi = -cosine_hemisphere(u);
        return {wi.z < 0, wi, surface.albedo, cosine_hemisphere_pdf(-wi.z), BRDF_DIFFUSE | BRDF_TRANSMISSION};
    }
};

}  // namespace etendue
