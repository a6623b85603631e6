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

AreaLight::AreaLight(const Mesh& mesh, const Material& material) : mesh_(&mesh), material_(&material) {
    std::vector<double> areas(mesh.triangles.size());
    for (size_t i = 0; i < areas.size(); ++i) areas[i] = mesh.area(static_cast<uint32_t>(i));
    triangles_ = Distribution1D(areas);
    area_ = static_cast<float>(triangles_.total());
    power_ = luminance(material.mean_emission()) * area_ * PI;
}

std::optional<LightSample> AreaLight::sample_Li(const vec3& reference, const vec2& u) const {
    const auto triangle = triangles_.sample(u.x);
    const vec2 b = uniform_triangle({triangle.remapped, u.y});
    const SurfacePoint point = mesh_->facets[triangle.index].point(b);
    const vec3 to_light = point.position - reference;
    const float distance2 = length2(to_light);
    if (distance2 == 0) return std::nullopt;
    const vec3 wi = to_light / std::sqrt(distance2);
    const float cos_light = -glm::dot(wi, point.normal);
    if (cos_light <= 0) return std::nullopt;
    const vec2 uv = material_->is_textured() ? mesh_->uv(triangle.index, b) : vec2(0);
    if (material_->is_cut_out(uv)) return std::nullopt;
    // In place: a copy would wait for what was just written.
    return std::optional<LightSample>(std::in_place, material_->emission_at(uv), wi,
                                      distance2 / (cos_light * area_), point, false);
}

float AreaLight::pdf_Li(const SurfaceHit& hit) const {
    // hit.point.normal is turned towards wo; the back of a light is never sampled.
    const float cos_light = glm::dot(hit.wo, hit.point.normal);
    return hit.front && cos_light > 0 ? sqr(hit.distance) / (cos_light * area_) : 0;
}

}  // namespace etendue
