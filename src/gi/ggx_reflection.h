// GGX reflection as a BSDF, but for its Fresnel term: what rough metals and rough dielectrics share.
#pragma once

#include "gi/bsdf.h"
#include "gi/microfacet.h"

namespace etendue {

/// The derived BSDF defines the reflectance of a facet, `fresnel(surface, cos_h)`.
template <class Derived>
struct GgxReflection : Bsdf {
    static constexpr bool is_reciprocal = true;

    static vec3 albedo(const Surface& surface) { return surface.tint() * Derived::fresnel(surface, 1); }

    static vec3 f(const Surface& surface, const vec3& wo, const vec3& wi) {
        if (wi.z <= 0) return vec3(0);
        const float fresnel = Derived::fresnel(surface, glm::dot(wo, Ggx::half(wo, wi)));
        return surface.tint() * (fresnel * Ggx(surface.roughness).reflection(wo, wi));
    }

    static float pdf(const Surface& surface, const vec3& wo, const vec3& wi) {
        return wi.z > 0 ? Ggx(surface.roughness).reflection_pdf(wo, wi) : 0;
    }

    static std::optional<BsdfSample> sample(const Surface& surface, const vec3& wo, float, const vec2& u) {
        const Ggx ggx(surface.roughness);
        const vec3 h = ggx.sample_visible(wo, u);
        const vec3 wi = Ggx::mirrored(wo, h);
        if (wi.z <= 0) return std::nullopt;
        const float fresnel = Derived::fresnel(surface, glm::dot(wo, h));
        const vec3 weight = surface.tint() * (fresnel * ggx.G2(wo, wi) / ggx.G1(wo));
        return BsdfSample{wi, weight, ggx.reflection_pdf(wo, wi), BRDF_GLOSSY};
    }
};

}  // namespace etendue
