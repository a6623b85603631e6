// The surface of a lamp: it emits, and absorbs what arrives, so that paths end on it.
#pragma once

#include "gi/bsdf.h"

namespace etendue {

struct LightBsdf : Bsdf {
    static constexpr std::string_view name = "light";
    static constexpr std::string_view summary = "emits from its front, absorbs what arrives";
    static constexpr bool is_reciprocal = true;
    static constexpr MaterialType types[] = {
        {.name = "light",
         .summary = summary,
         .order = 10,
         .match = {"emissive", "light"},
         .emissive_strength = 10},
    };

    static vec3 albedo(const Surface&) { return vec3(0); }
};

}  // namespace etendue
