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

    static vec3 albedo(const Surface& surface) { return surface.albedo * fresnel_dielectric(1, surface.ior); }

    static std::optional<BsdfSample> sample(const Surface& surface, const vec3& wo, float, const vec2&) {
        return BsdfSample{vec3(-wo.x, -wo.y, wo.z), surface.albedo * fresnel_dielectric(wo.z, surface.ior), 1,
                          BRDF_SPECULAR};
    }
};

}  // namespace etendue
