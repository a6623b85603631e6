#include "algorithms/portals.h"

namespace etendue {

Portals::Portals(const Scene& scene) : meshes_(scene.meshes().data()) {
    std::vector<EmitterBounds> emitters;
    for (const Mesh& mesh : scene.meshes()) {
        first_.push_back(static_cast<uint32_t>(emitters.size()));
        if (!bsdf_is_delta(scene.materials()[mesh.material].bsdf)) continue;
        for (uint32_t triangle = 0; triangle < mesh.triangles.size(); ++triangle) {
            const Facet& facet = mesh.facets[triangle];
            EmitterBounds bounds{.normals = {facet.normal, 1}, .power = facet.area};
            for (const vec3& corner : facet.corners) {
                bounds.lower = min(bounds.lower, corner), bounds.upper = max(bounds.upper, corner);
            }
            emitters.push_back(bounds);
            places_.push_back({&mesh, triangle});
        }
    }
    tree_ = LightTree(emitters);
}

ETENDUE_LANES_FLATTEN Portals::Light Portals::light(LaneContext& context, const SurfaceHits& hits,
                                                    const LaneMask& on, float max_edges, Mis mis) const {
    // A point of a triangle.
    context.sampler.start_vertex(0);
    const PerLane<float> finer_digits = to_array(context.sampler.next_1d(on));
    const LaneVec2 u = context.sampler.next_2d(on);
    const PerLane<float> x = to_array(u.x);
    PerLane<double> numbers{};
    for_lanes(on, [&](int i) { numbers[i] = std::min(light_number(x[i], finer_digits[i]), 1 - 0x1p-52); });
    const auto choices = tree_.sample(on, hits.point.position, numbers, {});
    PerLane<const Facet*> facets;
    facets.fill(&NO_FACET);
    PerLane<Place> places{};
    PerLane<float> pmfs{}, remapped{};
    PerLane<bool> chosen{};
    for_lanes(on, [&](int i) {
        if (!choices[i]) return;
        chosen[i] = true;
        places[i] = places_[choices[i]->emitter];
        facets[i] = &places[i].mesh->facets[places[i].triangle];
        pmfs[i] = choices[i]->pmf;
        remapped[i] = std::min(static_cast<float>(choices[i]->remapped), ONE_MINUS_EPSILON);
    });
    const FacetLanes facet(facets);
    const SurfacePointOf<Lanes> g = facet.point(uniform_triangle(LaneVec2{lanes_of(remapped), u.y}));

    // The bounce to it.
    const LaneVec3 to = g.position - hits.point.position;
    const Lanes distance2 = dot(to, to);
    const LaneVec3 wi = to * (1 / sqrt(distance2));
    const Lanes cos_g = -dot(wi, facet.normal);
    LaneMask alive = mask_of(chosen) && distance2 > 0 && cos_g > 0;
    if (!any(alive)) return {};
    const BsdfValueOf<Lanes> bsdf = hits.values(alive, wi);
    ContributionOf<Lanes> found{Technique::light_sampling};
    found.by_portal = true;
    found.pdf = lanes_of(pmfs) / facet.area * distance2 / cos_g;
    found.other_pdf = bsdf.pdf;
    found.weight = light_sampling_weight(mis, found.pdf, found.other_pdf);
    LaneVec3 throughput = bsdf.f * (abs(dot(wi, hits.frame.n)) / found.pdf);
    alive = alive && !is_black(throughput);
    LaneRays rays = hits.rays_towards(wi);

    // And on to a light, over delta surfaces alone.
    Light light;
    for (found.edges = 2; any(alive); found.edges += 1) {
        SurfaceHits at = context.intersect_aside(rays, alive);
        if (all_of(found.edges == 2)) {
            PerLane<bool> is_meant{};
            for_lanes(alive && at.valid, [&](int i) {
                is_meant[i] =
                    at.found.part[i]->mesh == places[i].mesh && at.found.triangle[i] == places[i].triangle;
            });
            alive = alive && mask_of(is_meant);
        } else {
            const LaneMask shines = alive && at.is_light;
            if (any(shines)) {
                found.unweighted = throughput * etendue::Light::found(shines, at, true).radiance;
                light.radiance += context.light(found, shines);
                const Lanes all = found.pdf + found.other_pdf;
                light.gain += select(
                    shines, found.unweighted * found.unweighted * (sqr(found.pdf) / (found.other_pdf * all)),
                    LaneVec3(0));
            }
        }
        alive = alive && at.valid && at.is_delta && found.edges < max_edges;
        if (!any(alive)) break;
        at.read_colours();
        context.sampler.start_vertex(found.edges);
        const Lanes lobe = context.sampler.next_1d(alive);
        const BsdfSampleOf<Lanes> bounce = at.sample(alive, lobe, context.sampler.next_2d(alive));
        throughput *= bounce.weight;
        alive = alive && bounce.exists && !is_black(throughput);
        rays = at.rays_towards(bounce.wi);
    }
    return light;
}

Lanes Portals::pdfs(const LaneMask& on, const LaneVec3& from, const SurfaceHits& hits) const {
    PerLane<float> pdfs{};
    const PerLane<float> cos_g = to_array(dot(hits.wo, hits.point.normal));
    for_lanes(on && hits.front, [&](int i) {
        const Mesh* const mesh = hits.found.part[i]->mesh;
        const uint32_t triangle = hits.found.triangle[i];
        pdfs[i] = tree_.pmf(from.lane(i), first_[mesh - meshes_] + triangle) / mesh->facets[triangle].area *
                  sqr(hits.found.distance[i]) / cos_g[i];
    });
    return lanes_of(pdfs);
}

}  // namespace etendue
