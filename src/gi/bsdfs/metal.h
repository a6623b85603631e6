// A rough conductor: GGX reflection with the complex index eta = ior, k = absorb.
#pragma once

#include "gi/fresnel.h"
#include "gi/ggx_reflection.h"

namespace etendue {

struct Metal : GgxReflection<Metal> {
    static constexpr std::string_view name = "metal";
    static constexpr std::string_view summary = "GGX conductor, eta = ior, k = absorb";
    static constexpr MaterialType types[] = {
        {.name = "metal",
         .summary = summary,
         .order = 110,
         .match = {"metal"},
         .ior = 2.42f,
         .absorb = 0.95f},
        {.name = "gold",
         .summary = "metal with the index and colour of gold",
         .order = 120,
         .match = {"gold"},
         .ior = 0.75f,
         .absorb = 2.12f,
         .roughness = roughness_of_exponent(350),
         .albedo = {235 / 255.f, 197 / 255.f, 73 / 255.f}},
        {.name = "silver",
         .summary = "metal with the index and colour of silver",
         .order = 130,
         .match = {"silver"},
         .ior = 0.15f,
         .absorb = 2.75f,
         .roughness = roughness_of_exponent(100),
         .albedo = {144 / 255.f, 144 / 255.f, 144 / 255.f}},
        {.name = "copper",
         .summary = "metal with the index and colour of copper",
         .order = 140,
         .match = {"copper"},
         .ior = 1.12f,
         .absorb = 2.5f,
         .roughness = roughness_of_exponent(75),
         .albedo = {176 / 255.f, 72 / 255.f, 33 / 255.f}},
    };

    template <class F>
    static F fresnel(const SurfaceOf<F>& surface, const F& cos_h) {
        // Where nothing is reflected rounding leaves a little less than that.
        return max(fresnel_conductor(cos_h, surface.ior, surface.absorb), F(0));
    }
};

}  // namespace etendue
