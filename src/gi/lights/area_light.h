// A mesh whose material emits, from its front only.
#pragma once

#include "gi/distribution.h"
#include "gi/light_sample.h"

namespace etendue {

class AreaLight {
  public:
    static constexpr std::string_view name = "AreaLight";

    /// One for every mesh whose material emits.
    static std::vector<AreaLight> find(const LightContext& context);

    AreaLight(const Mesh& mesh, const Material& material);

    /// A triangle chosen by area and a uniform point on it: pdf_area = 1 / area, turned into solid angle.
    std::optional<LightSample> sample_Li(const vec3& reference, const vec2& u) const;
    float pdf_Li(const SurfaceHit& hit) const;
    vec3 Le(const SurfaceHit& hit) const { return hit.front ? material_->emission_at(hit.uv()) : vec3(0); }
    vec3 Le(const vec3&) const { return vec3(0); }
    float power() const { return power_; }
    const Mesh* mesh() const { return mesh_; }

  private:
    const Mesh* mesh_;
    const Material* material_;
    Distribution1D triangles_;
    float area_, power_;
};

}  // namespace etendue
