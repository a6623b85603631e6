// A smooth dielectric boundary: mirror and refraction, chosen by Fresnel reflectance.
#pragma once

#include "gi/bsdf.h"
#include "gi/fresnel.h"

namespace etendue {

struct Glass : Bsdf {
    static constexpr std::string_view name = "glass";
    static constexpr std::string_view summary = "smooth dielectric, mirror and refraction by Fresnel";
    static constexpr bool is_delta = true;
    static constexpr MaterialType types[] = {
        {.name = "glass", .summary = summary, .order = 90, .match = {"glass", "staklo"}, .ior = 1.52f},
        {.name = "water",
         .summary = "glass with the index and colour of water",
         .order = 100,
         .match = {"water"},
         .ior = 1.33f,
         .roughness = 1e-4f,
         .albedo = {64 / 255.f, 164 / 255.f, 223 / 255.f}},
    };

    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>& surface, const Vec3<F>& wo, const F& lobe,
                                  const Vec2<F>&) {
        const F eta = surface.eta();
        const F reflectance = fresnel_dielectric(wo.z, eta);
        // On total reflection the reflectance is 1, above every `lobe`.
        const Mask<F> reflects = lobe < reflectance;
        const Vec3<F> wi = select(reflects, Vec3<F>(-wo.x, -wo.y, wo.z), refract(wo, eta));
        // Radiance gathers or spreads with the solid angle as it crosses the boundary (pbrt 4th ed., 9.5.2).
        const F eta2 = select(reflects, F(1), sqr(eta));
        return {Mask<F>(true),
                wi,
                surface.albedo / eta2,
                select(reflects, reflectance, 1 - reflectance),
                select(reflects, F(BRDF_SPECULAR), F(BRDF_SPECULAR | BRDF_TRANSMISSION)),
                eta2};
    }
};

}  // namespace etendue
