#include "algorithms/lane_context.h"

namespace etendue {

void LaneContext::tell_edges(const LaneRays& lane_rays, const LaneMask& on, const SurfaceHits& hits) {
    tell_each(on, [&](Observer& observer, int i) {
        const FoundHits& found = hits.found;
        const Ray ray = ray_of(lane_rays, i);
        const ScenePart* const part = found.part[i];
        observer.edge(ray, part ? SurfaceHit(ray, found.distance[i], *part->mesh, found.triangle[i],
                                             found.barycentrics(i), *part->material, found.light[i])
                                : SurfaceHit(ray, found.light[i]));
    });
}

void LaneContext::tell_portal_rays(const LaneRays& lane_rays, const LaneMask& on) {
    tell_each(on, [&](Observer& observer, int i) { observer.portal_ray(ray_of(lane_rays, i)); });
}

void LaneContext::tell_shadow_rays(const LaneRays& lane_rays, const LaneMask& on, const LaneMask& visible) {
    tell_each(on, [&](Observer& observer, int i) { observer.shadow_ray(ray_of(lane_rays, i), visible[i]); });
}

void LaneContext::tell_bounces(const BsdfSampleOf<Lanes>& samples, const LaneMask& on) {
    tell_each(on, [&](Observer& observer, int i) {
        observer.bounce({samples.exists[i], samples.wi.lane(i), samples.weight.lane(i), samples.pdf[i],
                         samples.type[i], samples.eta2[i]});
    });
}

void LaneContext::tell_roulette(const Lanes& q, const LaneMask& plays, const LaneMask& survives) {
    tell_each(plays, [&](Observer& observer, int i) { observer.roulette(q[i], survives[i]); });
}

void LaneContext::tell_contributions(const ContributionOf<Lanes>& found, const LaneMask& on) {
    tell_each(on, [&](Observer& observer, int i) {
        observer.contribution({found.technique, found.edges[i], found.unweighted.lane(i), found.weight[i],
                               found.pdf[i], found.other_pdf[i], found.borrowed, found.from_light,
                               found.by_portal});
    });
}

}  // namespace etendue
