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

    static vec3 f(const Surface& surface, const vec3&, const vec3& wi) {
        return wi.z > 0 ? surface.albedo * INV_PI : vec3(0);
    }

    static float pdf(const Surface&, const vec3&, const vec3& wi) { return cosine_hemisphere_pdf(wi.z); }

    static std::optional<BsdfSample> sample(const Surface& surface, const vec3&, float, const vec2& u) {
        const vec3 wi = cosine_hemisphere(u);
        if (wi.z <= 0) return std::nullopt;
        return BsdfSample{wi, surface.albedo, cosine_hemisphere_pdf(wi.z), BRDF_DIFFUSE};
    }
};

}  // namespace etendue
