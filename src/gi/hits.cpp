#include "gi/hits.h"

#include "gi/light.h"

namespace etendue {

namespace {

// Of lanes that hit nothing.
const FacetShading NO_SHADING{};
const Mesh NO_MESH{};
const Material NO_MATERIAL{};
const ScenePart NO_PART(NO_MESH, NO_MATERIAL);

float number(bool truth) { return truth ? 1.f : 0.f; }

}  // namespace

ScenePart::ScenePart(const Mesh& part_mesh, const Material& part_material)
    : line{part_material.albedo,
           part_material.ior,
           part_material.roughness,
           part_material.absorb,
           static_cast<float>(part_material.bsdf),
           number(part_material.coated),
           number(bsdf_is_delta(part_material.bsdf)),
           number(part_material.albedo_texture),
           number(part_material.normal_texture),
           {}},
      mesh(&part_mesh),
      material(&part_material) {}

ETENDUE_LANES_FLATTEN SurfaceHits::SurfaceHits(const LaneRays& rays, const LaneMask& on,
                                               const FoundHits& hits)
    : wo(-rays.direction), found(hits) {
    PerLane<const Facet*> facets;
    PerLane<const float*> lines;
    PerLane<bool> hit, light;
    for (int i = 0; i < LANES; ++i) {
        const ScenePart* const part = found.part[i];
        facets[i] = part ? &part->mesh->facets[found.triangle[i]] : &NO_FACET;
        lines[i] = &(part ? part : &NO_PART)->line.albedo.x;
        hit[i] = part != nullptr;
        light[i] = found.light[i] != nullptr;
    }
    valid = on && mask_of(hit);
    is_light = on && mask_of(light);

    const LineColumns materials = columns_of(lines);
    surface_.albedo = vector_at(materials, 0);
    surface_.ior = materials[3], surface_.roughness = materials[4], surface_.absorb = materials[5];
    bsdf_ = materials[6];
    surface_.coated = materials[7] > 0;
    is_delta = materials[8] > 0;
    textured_ = materials[9] > 0;
    for_lanes(textured_, [&](int i) { found.part[i]->material->albedo_texture->prefetch(found.uv(i)); });

    const FacetLanes triangle(facets);
    point = triangle.point({lanes_of(found.b1), lanes_of(found.b2)});
    front = dot(point.normal, wo) > 0;
    point.normal = select(front, point.normal, -point.normal);
    surface_.front = front;

    const LaneMask smooth = triangle.smooth > 0, mapped = materials[10] > 0;
    frame = FrameOf<Lanes>(any(smooth || mapped) ? shading_normals(smooth, mapped) : point.normal);
    wo_local = frame.to_local(wo);
}

LaneVec3 SurfaceHits::shading_normals(const LaneMask& smooth, const LaneMask& mapped) {
    // As the mesh has it, on the front.
    const LaneVec3 geometric = select(front, point.normal, -point.normal);
    LaneVec3 n = geometric;
    if (any(smooth)) {
        PerLane<const float*> lines;
        lines.fill(&NO_SHADING.normals[0].x);
        for_lanes(smooth,
                  [&](int i) { lines[i] = &found.part[i]->mesh->shading[found.triangle[i]].normals[0].x; });
        const LineColumns columns = columns_of(lines);
        const Lanes b1 = lanes_of(found.b1), b2 = lanes_of(found.b2);
        const LaneVec3 mean =
            (1 - b1 - b2) * vector_at(columns, 0) + b1 * vector_at(columns, 3) + b2 * vector_at(columns, 6);
        n = select(smooth && length2(mean) > 0, normalize(mean), geometric);
        n = select(dot(n, geometric) < 0, -n, n);
    }
    if (any(mapped)) {
        VectorArrays normals;
        for_lanes(mapped, [&](int i) {
            const ScenePart& part = *found.part[i];
            normals.set(i, mapped_normal(*part.material, *part.mesh, found.triangle[i], found.barycentrics(i),
                                         n.lane(i)));
        });
        n = select(mapped, normals.lanes(), n);
    }
    const ClearNormal<LaneVec3> normal(select(front, n, -n), wo, point.normal);
    is_bent = (smooth || mapped) && normal.is_bent;
    return select(smooth || mapped, normal.n, point.normal);
}

void SurfaceHits::read_colours() {
    if (!any(textured_)) return;
    VectorArrays colours;
    for_lanes(textured_,
              [&](int i) { colours.set(i, found.part[i]->material->albedo_texture->colour(found.uv(i))); });
    surface_.albedo = select(textured_, colours.lanes(), surface_.albedo);
}

SurfaceHit SurfaceHits::seen_by_light(int lane) const {
    SurfaceHit hit;
    hit.valid = found.part[lane] != nullptr;
    hit.front = front[lane];
    hit.wo = wo.lane(lane);
    hit.distance = found.distance[lane];
    hit.point.normal = point.normal.lane(lane);
    hit.light = found.light[lane];
    hit.mesh = hit.valid ? found.part[lane]->mesh : nullptr;
    hit.triangle = found.triangle[lane];
    hit.barycentrics = found.barycentrics(lane);
    return hit;
}

BsdfValueOf<Lanes> SurfaceHits::values(const LaneMask& on, const LaneVec3& wi) const {
    const LaneVec3 local = frame.to_local(wi);
    const LaneMask above = dot(wi, point.normal) > 0;
    return bsdf_values(on && (local.z > 0) == above, bsdf_, surface_, wo_local, local);
}

BsdfSampleOf<Lanes> SurfaceHits::sample(const LaneMask& on, const Lanes& lobe, const LaneVec2& u) const {
    BsdfSampleOf<Lanes> sample = bsdf_samples(on, bsdf_, surface_, wo_local, lobe, u);
    const LaneMask above = sample.wi.z > 0;
    sample.wi = frame.to_world(sample.wi);
    sample.exists = sample.exists && above == (dot(sample.wi, point.normal) > 0);
    return sample;
}

}  // namespace etendue
