// A mesh whose material emits, from its front only.
#pragma once

#include "gi/light_sample.h"
#include "gi/light_tree.h"

namespace etendue {

class AreaLight {
  public:
    static constexpr std::string_view name = "AreaLight";

    /// One for every mesh whose material emits.
    static std::vector<AreaLight> find(const LightContext& context);

    AreaLight(const Mesh& mesh, const Material& material);

    /// A uniform point on the triangle: pdf_area = 1 / its area, turned into solid angle.
    LightSample sample_Li(const vec3& reference, uint32_t triangle, const vec2& u, bool with_mis) const;
    /// The same for points in lanes, each with a light and a triangle of its own.
    static LightSampleOf<Lanes> sample_Li(const LaneMask& on, const LaneVec3& reference,
                                          const PerLane<const AreaLight*>& lights,
                                          const PerLane<uint32_t>& triangles, const LaneVec2& u,
                                          bool with_mis);
    float pdf_Li(const SurfaceHit& hit, bool with_mis) const;
    vec3 Le(const SurfaceHit& hit) const { return hit.front ? material_->emission_at(hit.uv()) : vec3(0); }
    vec3 Le(const vec3&) const { return vec3(0); }
    float power() const { return power_; }
    EmitterBounds bounds(uint32_t triangle) const;
    const Mesh* mesh() const { return mesh_; }

  private:
    /// Empty where the surface is cut out.
    std::optional<vec3> emission_at(uint32_t triangle, const vec2& b) const;

    const Mesh* mesh_;
    const Material* material_;
    bool is_textured_;
    vec3 emission_;           // where it is not textured
    float exitance_, power_;  // luminous power of a unit of area, and of all
};

}  // namespace etendue
