// Lambertian reflection: f = albedo / pi.
#pragma once

#include "gi/bsdf.h"

namespace etendue {

struct Diffuse : Bsdf {
    static constexpr std::string_view name = "diffuse";
    static constexpr std::string_view summary = "Lambertian reflection";
    static constexpr bool is_reciprocal = true;
    static constexpr MaterialType types[] = {
        {.name = "diffuse", .summary = summary, .order = 30, .match = {"diffuse", "fabric"}},
    };

    template <class F>
    static F diffuse_share(const F&, const F&) {
        return 1;
    }

    template <class F>
    static Vec3<F> f(const SurfaceOf<F>& surface, const Vec3<F>&, const Vec3<F>& wi) {
        return select(wi.z > 0, surface.albedo * F(INV_PI), Vec3<F>(0));
    }

    template <class F>
    static F pdf(const SurfaceOf<F>&, const Vec3<F>&, const Vec3<F>& wi) {
        return cosine_hemisphere_pdf(wi.z);
    }

    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>& surface, const Vec3<F>&, const F&, const Vec2<F>& u) {
        const Vec3<F> wi = cosine_hemisphere(u);
        return {wi.z > 0, wi, surface.albedo, cosine_hemisphere_pdf(wi.z), BRDF_DIFFUSE};
    }
};

}  // namespace etendue
