// A mirror with the reflectance of a dielectric; what is not reflected is absorbed.
#pragma once

#include "gi/bsdf.h"
#include "gi/fresnel.h"

namespace etendue {

struct Specular : Bsdf {
    static constexpr std::string_view name = "specular";
    static constexpr std::string_view summary = "mirror, dielectric Fresnel";
    static constexpr bool is_delta = true;
    static constexpr MaterialType types[] = {
        {.name = "specular", .summary = summary, .order = 40, .match = {"specular"}, .ior = 1.52f},
    };

    static vec3 albedo(const Surface& surface) {
        return surface.albedo * fresnel_dielectric(1.f, surface.ior);
    }

    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>& surface, const Vec3<F>& wo, const F&, const Vec2<F>&) {
        const Vec3<F> weight = surface.albedo * fresnel_dielectric(wo.z, surface.ior);
        return {Mask<F>(true), Vec3<F>(-wo.x, -wo.y, wo.z), weight, 1, BRDF_SPECULAR};
    }
};

}  // namespace etendue
