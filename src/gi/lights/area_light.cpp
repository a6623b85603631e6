#include "gi/lights/area_light.h"

namespace etendue {

namespace {

/// Towards a point of a triangle that shines to its front: all but the radiance.
template <class F>
LightSampleOf<F> towards_point(const TriangleOf<F>& triangle, const Vec2<F>& b, const Vec3<F>& reference) {
    LightSampleOf<F> sample;
    sample.point = triangle.point(b);
    const Vec3<F> to_light = sample.point.position - reference;
    const F distance2 = length2(to_light);
    sample.wi = to_light / sqrt(distance2);
    const F cos_light = -dot(sample.wi, triangle.normal);
    sample.pdf = distance2 / (cos_light * triangle.area);
    sample.exists = distance2 > 0 && cos_light > 0;
    return sample;
}

}  // namespace

std::vector<AreaLight> AreaLight::find(const LightContext& context) {
    std::vector<AreaLight> lights;
    for (const Mesh& mesh : context.meshes) {
        const Material& material = context.materials[mesh.material];
        if (material.emits()) lights.emplace_back(mesh, material);
    }
    return lights;
}

AreaLight::AreaLight(const Mesh& mesh, const Material& material)
    : mesh_(&mesh),
      material_(&material),
      is_textured_(material.is_textured()),
      emission_(material.emission_at(vec2(0))),
      exitance_(luminance(material.mean_emission()) * PI) {
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

LightSample AreaLight::sample_Li(const vec3& reference, uint32_t triangle, const vec2& u, bool) const {
    const vec2 b = uniform_triangle(u);
    LightSample sample = towards_point<float>(mesh_->facets[triangle], b, reference);
    if (!sample.exists) return sample;
    const auto emission = emission_at(triangle, b);
    sample.exists = emission.has_value();
    if (emission) sample.radiance = *emission;
    return sample;
}

ETENDUE_LANES_FLATTEN LightSampleOf<Lanes> AreaLight::sample_Li(const LaneMask& on, const LaneVec3& reference,
                                                                const PerLane<const AreaLight*>& lights,
                                                                const PerLane<uint32_t>& triangles,
                                                                const LaneVec2& u, bool) {
    PerLane<const Facet*> facets;
    facets.fill(&NO_FACET);
    for_lanes(on, [&](int i) { facets[i] = &lights[i]->mesh_->facets[triangles[i]]; });
    const LaneVec2 b = uniform_triangle(u);
    LightSampleOf<Lanes> samples = towards_point<Lanes>(FacetLanes(facets), b, reference);
    samples.exists = samples.exists && on;
    VectorArrays radiance;
    PerLane<bool> cut_out{};
    for_lanes(samples.exists, [&](int i) {
        const AreaLight& light = *lights[i];
        if (!light.is_textured_) return radiance.set(i, light.emission_);
        const auto emission = light.emission_at(triangles[i], {b.x[i], b.y[i]});
        cut_out[i] = !emission;
        if (emission) radiance.set(i, *emission);
    });
    samples.exists = samples.exists && !mask_of(cut_out);
    samples.radiance = radiance.lanes();
    return samples;
}

std::optional<vec3> AreaLight::emission_at(uint32_t triangle, const vec2& b) const {
    const vec2 uv = is_textured_ ? mesh_->uv(triangle, b) : vec2(0);
    if (material_->is_cut_out(uv)) return std::nullopt;
    return material_->emission_at(uv);
}

float AreaLight::pdf_Li(const SurfaceHit& hit, bool) const {
    // hit.point.normal is turned towards wo; the back of a light is never sampled.
    const float cos_light = glm::dot(hit.wo, hit.point.normal);
    return hit.front && cos_light > 0 ? sqr(hit.distance) / (cos_light * mesh_->facets[hit.triangle].area)
                                      : 0;
}

}  // namespace etendue
