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

    static std::optional<BsdfSample> sample(const Surface& surface, const vec3& wo, float lobe, const vec2&) {
        const float eta = surface.eta();
        const float reflectance = fresnel_dielectric(wo.z, eta);
        if (lobe < reflectance)
            return BsdfSample{vec3(-wo.x, -wo.y, wo.z), surface.albedo, reflectance, BRDF_SPECULAR};
        const auto wi = refract(wo, eta);
        if (!wi) return std::nullopt;
        // Radiance gathers or spreads with the solid angle as it crosses the boundary (pbrt 4th ed., 9.5.2).
        return BsdfSample{*wi, surface.albedo / sqr(eta), 1 - reflectance, BRDF_SPECULAR | BRDF_TRANSMISSION,
                          sqr(eta)};
    }
};

}  // namespace etendue
