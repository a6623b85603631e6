#include "gi/lights/area_light.h"

namespace etendue {

std::vector<AreaLight> AreaLight::find(const LightContext& context) {
    std::vector<AreaLight> lights;
    for (const Mesh& mesh : context.meshes) {
        const Material& material = context.materials[mesh.material];
        if (material.emits()) lights.emplace_back(mesh, material);
    }
    return lights;
}

AreaLight::AreaLight(const Mesh& mesh, const Material& material)
    : mesh_(&mesh), material_(&material), exitance_(luminance(material.mean_emission()) * PI) {
    double area = 0;
    for (uint32_t i = 0; i < mesh.triangles.size(); ++i) area += mesh.facets[i].area;
    power_ = static_cast<float>(area) * exitance_;
}

EmitterBounds AreaLight::bounds(uint32_t triangle) const {
    const Facet& facet = mesh_->facets[triangle];
    const auto& [a, b, c] = facet.corners;
    return {
        glm::min(a, glm::min(b, c)), glm::max(a, glm::max(b, c)), {facet.normal, 1}, facet.area * exitance_};
}

std::optional<LightSample> AreaLight::sample_Li(const vec3& reference, uint32_t triangle, const vec2& u,
                                                bool) const {
    const vec2 b = uniform_triangle(u);
    const Facet& facet = mesh_->facets[triangle];
    const SurfacePoint point = facet.point(b);
    const vec3 to_light = point.position - reference;
    const float distance2 = length2(to_light);
    if (distance2 == 0) return std::nullopt;
    const vec3 wi = to_light / std::sqrt(distance2);
    const float cos_light = -glm::dot(wi, point.normal);
    if (cos_light <= 0) return std::nullopt;
    const vec2 uv = material_->is_textured() ? mesh_->uv(triangle, b) : vec2(0);
    if (material_->is_cut_out(uv)) return std::nullopt;
    // In place: a copy would wait for what was just written.
    return std::optional<LightSample>(std::in_place, material_->emission_at(uv), wi,
                                      distance2 / (cos_light * facet.area), point, false);
}

float AreaLight::pdf_Li(const SurfaceHit& hit, bool) const {
    // hit.point.normal is turned towards wo; the back of a light is never sampled.
    const float cos_light = glm::dot(hit.wo, hit.point.normal);
    return hit.front && cos_light > 0 ? sqr(hit.distance) / (cos_light * mesh_->facets[hit.triangle].area)
                                      : 0;
}

}  // namespace etendue
