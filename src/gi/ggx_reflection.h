// GGX reflection as a BSDF, but for its Fresnel term: what rough metals and rough dielectrics share.
#pragma once

#include "gi/bsdf.h"
#include "gi/microfacet.h"

namespace etendue {

/// The derived BSDF defines the reflectance of a facet, `fresnel(surface, cos_h)`.
template <class Derived>
struct GgxReflection : Bsdf {
    static constexpr bool is_reciprocal = true;

    static vec3 albedo(const Surface& surface) { return surface.tint() * Derived::fresnel(surface, 1.f); }

    template <class F>
    static Vec3<F> f(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi) {
        const F fresnel = Derived::fresnel(surface, dot(wo, half_vector(wo, wi)));
        const F reflection = fresnel * Ggx<F>(surface.roughness).reflection(wo, wi);
        return select(wi.z > 0, surface.tint() * reflection, Vec3<F>(0));
    }

    template <class F>
    static F pdf(const SurfaceOf<F>& surface, const Vec3<F>& wo, const Vec3<F>& wi) {
        return select(wi.z > 0, Ggx<F>(surface.roughness).reflection_pdf(wo, wi), F(0));
    }

    template <class F>
    static BsdfSampleOf<F> sample(const SurfaceOf<F>& surface, const Vec3<F>& wo, const F&,
                                  const Vec2<F>& u) {
        const Ggx<F> ggx(surface.roughness);
        const Vec3<F> h = ggx.sample_visible(wo, u);
        const Vec3<F> wi = mirrored(wo, h);
        const F fresnel = Derived::fresnel(surface, dot(wo, h));
        const Vec3<F> weight = surface.tint() * (fresnel * ggx.G2(wo, wi) / ggx.G1(wo));
        return {wi.z > 0, wi, weight, ggx.reflection_pdf(wo, wi), BRDF_GLOSSY};
    }
};

}  // namespace etendue
