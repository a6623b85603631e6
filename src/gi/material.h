// What a surface is made of: the parameters of its BSDF and its emission.  The meaning of each is in
// docs/scene-format.md.
#pragma once

#include <cstdint>
#include <string>

#include "gi/math.h"
#include "gi/texture.h"

namespace etendue {

/// Index of a BSDF in the list that the build makes of src/gi/bsdfs/.
using BsdfKind = uint8_t;

struct Material {
    std::string name;
    BsdfKind bsdf = 0;
    vec3 albedo{0.8f};
    float ior = 1.5f;
    float roughness = 0.1f;  // GGX alpha
    float absorb = 0;        // imaginary part of a conductor's index
    bool coated = false;
    float emissive_strength = 0;
    const Texture* albedo_texture = nullptr;
    const Texture* emission_texture = nullptr;
    const Texture* normal_texture = nullptr;
    const Texture* cutout_texture = nullptr;

    /// A surface less opaque than this is not there.
    static constexpr float CUTOUT_OPACITY = 0.1f;

    bool is_textured() const {
        return albedo_texture || emission_texture || normal_texture || cutout_texture;
    }
    bool emits() const { return emissive_strength > 0; }
    bool is_cut_out(const vec2& uv) const {
        return cutout_texture && cutout_texture->opacity(uv) < CUTOUT_OPACITY;
    }
    vec3 albedo_at(const vec2& uv) const { return albedo_texture ? albedo_texture->colour(uv) : albedo; }

    /// Radiance leaving the front, in every direction.
    vec3 emission_at(const vec2& uv) const {
        return (emission_texture ? emission_texture->colour(uv) : albedo_at(uv)) * emissive_strength;
    }
    vec3 mean_emission() const {
        const Texture* const texture = emission_texture ? emission_texture : albedo_texture;
        return (texture ? texture->mean_colour() : albedo) * emissive_strength;
    }
};

}  // namespace etendue
