// A light of any kind.  What a kind has to offer is in light_sample.h.
#pragma once

#include <variant>

#include "gi/light_sample.h"
#include "gi/light_tree.h"
#include "light_list.h"  // made by CMakeLists.txt: includes lights/*.h and defines ETENDUE_LIGHTS

namespace etendue {

class Light {
  public:
    template <class Kind>
    explicit Light(Kind kind) : kind_(std::move(kind)) {}

    /// All lights of a scene, kind by kind, as each kind finds its own.
    static std::vector<Light> find_all(const LightContext& context);

    /// A point of one triangle of the light's mesh, or of the whole sky.
    LightSample sample_Li(const vec3& reference, uint32_t triangle, const vec2& u, bool with_mis) const {
        return std::visit(
            [&](const auto& light) { return light.sample_Li(reference, triangle, u, with_mis); }, kind_);
    }
    /// The same for points in lanes, each with a light and a triangle of its own.
    static LightSampleOf<Lanes> sample_Li(const LaneMask& on, const LaneVec3& reference,
                                          const PerLane<const Light*>& lights,
                                          const PerLane<uint32_t>& triangles, const LaneVec2& u,
                                          bool with_mis);
    /// What the rays of lanes found by chance: Le and pdf_Li.
    static FoundLightOf<Lanes> found(const LaneMask& on, const SurfaceHits& hits, bool with_mis);
    /// Density with which sample_Li would have drawn the direction `-hit.wo` in which a ray from the
    /// reference point, `hit.distance` away, found this triangle of the light.
    float pdf_Li(const SurfaceHit& hit, bool with_mis) const {
        return std::visit([&](const auto& light) { return light.pdf_Li(hit, with_mis); }, kind_);
    }
    /// Radiance emitted from a hit of this light towards hit.wo.
    vec3 Le(const SurfaceHit& hit) const {
        return std::visit([&](const auto& light) { return light.Le(hit); }, kind_);
    }
    /// Radiance arriving from a direction, of an environment light.
    vec3 Le(const vec3& direction) const {
        return std::visit([&](const auto& light) { return light.Le(direction); }, kind_);
    }
    /// Luminous power in scene units (luminance of radiance x area x solid angle), by which lights are
    /// chosen.
    float power() const {
        return std::visit([](const auto& light) { return light.power(); }, kind_);
    }
    /// Of one triangle of its mesh: where it is, where it faces, and its power.
    EmitterBounds bounds(uint32_t triangle) const {
        return std::visit(
            [&](const auto& light) {
                if constexpr (requires { light.bounds(triangle); }) return light.bounds(triangle);
                return EmitterBounds{};
            },
            kind_);
    }
    std::string_view name() const {
        return std::visit([](const auto& light) { return light.name; }, kind_);
    }
    /// The mesh that a ray hits to find this light; null for an environment light, which it finds by missing
    /// everything.
    const Mesh* mesh() const {
        return std::visit([](const auto& light) { return light.mesh(); }, kind_);
    }

  private:
    using Kinds = std::variant<ETENDUE_LIGHTS>;

    /// Calls visit(mask, lights) for each kind of which there are any in the lanes that are `on`: in which, and which.
    template <class Visit>
    static void for_kinds(const LaneMask& on, const PerLane<const Light*>& lights, const Visit& visit);

    Kinds kind_;
};

}  // namespace etendue
