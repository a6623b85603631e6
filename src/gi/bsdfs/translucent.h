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

    static vec3 f(const Surface& surface, const vec3&, const vec3& wi) {
        return wi.z < 0 ? surface.albedo * INV_PI : vec3(0);
    }

    static float pdf(const Surface&, const vec3&, const vec3& wi) { return cosine_hemisphere_pdf(-wi.z); }

    static std::optional<BsdfSample> sample(const Surface& surface, const vec3&, float, const vec2& u) {
        const vec3 wi = -cosine_hemisphere(u);
        if (wi.z >= 0) return std::nullopt;
        return BsdfSample{wi, surface.albedo, cosine_hemisphere_pdf(-wi.z), BRDF_DIFFUSE | BRDF_TRANSMISSION};
    }
};

}  // namespace etendue
