// GGX reflection off a rough dielectric whose inside is black.
#pragma once

#include "gi/fresnel.h"
#include "gi/ggx_reflection.h"

namespace etendue {

struct Microfacet : GgxReflection<Microfacet> {
    static constexpr std::string_view name = "microfacet";
    static constexpr std::string_view summary = "GGX reflection, dielectric Fresnel";
    static constexpr MaterialType types[] = {
        {.name = "microfacet", .summary = summary, .order = 60, .match = {"microfacet"}, .ior = 2.42f},
    };

    template <class F>
    static F fresnel(const SurfaceOf<F>& surface, const F& cos_h) {
        return fresnel_dielectric(cos_h, surface.ior);
    }
};

}  // namespace etendue
