#include "algorithms/path_reuse.h"

namespace etendue {

void PathReuse::begin(const CameraSample& sample) {
    Path& path = paths_.emplace_back();
    ys_.emplace_back();
    connections_.resize(paths_.size() * MOST_PIXELS);
    path.observer = sample.observer;
    if (!sample.shares) return;
    path.place = paths_[paths_.size() - 2].place + 1;
    for (uint32_t back = 0; back <= path.place; ++back) {
        paths_[paths_.size() - 1 - back].size = path.place + 1;
    }
}

void PathReuse::add_second(const LaneMask& on, const PerLane<size_t>& samples, const Second& second) {
    const SurfaceHits& hits = second.hits;
    const LaneVec3 shared_light = hits.surfaces().albedo * Lanes(INV_PI);
    const LaneVec3 own_light = second.throughput * max(second.f - second.share * shared_light, LaneVec3(0));
    const BsdfSampleOf<Lanes>& bounce = second.bounce;
    const LaneVec3 shared_bounce =
        select(bounce.exists, shared_light * (abs(dot(bounce.wi, hits.frame.n)) / bounce.pdf), LaneVec3(0));
    const LaneVec3 own_bounce = select(
        bounce.exists, second.throughput * max(bounce.weight - second.share * shared_bounce, LaneVec3(0)),
        LaneVec3(0));
    const LaneVec3 radiance = shared_light * second.irradiance;
    const LaneVec3 own = second.radiance + own_light * second.irradiance;
    for_lanes(on, [&](int i) {
        Path& path = paths_[samples[i]];
        ys_[samples[i]] = {hits.point.position.lane(i),
                           hits.point.reach[i],
                           hits.point.normal.lane(i),
                           hits.frame.n.lane(i),
                           radiance.lane(i),
                           hits.surfaces().ior[i],
                           hits.bsdfs()[i],
                           1};
        path.survival = second.survival[i];
        path.own = own.lane(i);
        path.shared_bounce = shared_bounce.lane(i), path.own_bounce = own_bounce.lane(i);
        path.shared_light = shared_light.lane(i), path.own_light = own_light.lane(i);
        if (path.beyond) path.beyond->leave();
    });
}

void PathReuse::end(size_t sample, const vec3& radiance) {
    Path& path = paths_[sample];
    Shared& y = ys_[sample];
    if (y.exists == 0) {
        path.own = radiance;
        return;
    }
    path.own += path.own_bounce * radiance;
    y.radiance = path.survival * (y.radiance + path.shared_bounce * radiance);
    y.exists = is_black(y.radiance) ? 0.f : 1.f;
}

std::vector<PathReuse::Estimates> PathReuse::estimates() const {
    std::vector<float> densities(paths_.size());
    for (size_t k = 0; k < paths_.size(); ++k) densities[k] = density(k);
    std::vector<Estimates> all(paths_.size());
    for (size_t i = 0; i < paths_.size(); ++i) {
        const Path& path = paths_[i];
        all[i] = {path.own, path.own};
        for (uint32_t partner = 0; partner < path.size; ++partner) {
            const size_t k = partner_of(i, partner);
            const Connection& connection = at(i, partner);
            vec3 worth(0);
            if (connection.density > 0) {
                worth = connection.value / densities[k];
                all[i].shared += worth * ys_[k].radiance;
                if (partner == 0) all[i].alone += connection.value / connection.density * ys_[k].radiance;
            }
            if (path.observer && paths_[k].beyond) tell(path, paths_[k], worth, partner > 0);
        }
    }
    return all;
}

void PathReuse::tell(const Path& path, const Path& found_by, const vec3& worth, bool borrowed) {
    const vec3 shared = worth * found_by.survival;
    const float own = borrowed ? 0.f : 1.f;
    found_by.beyond->tell(*path.observer, shared * found_by.shared_light + own * found_by.own_light,
                          shared * found_by.shared_bounce + own * found_by.own_bounce, borrowed);
}

size_t PathReuse::partner_of(size_t path, uint32_t partner) const {
    const Path& of = paths_[path];
    return path - of.place + (of.place + partner) % of.size;
}

float PathReuse::density(size_t path) const {
    const Path& of = paths_[path];
    if (ys_[path].exists == 0) return 0;
    float sum = 0;
    for (uint32_t place = 0; place < of.size; ++place) {
        sum += at(path - of.place + place, (of.place + of.size - place) % of.size).density;
    }
    return sum;
}

ETENDUE_LANES_FLATTEN void PathReuse::connect(LaneContext& context, size_t first, const LaneMask& on,
                                              const SurfaceHits& hits) {
    uint32_t partners = 0;
    for_lanes(on, [&](int i) { partners = std::max(partners, paths_[first + i].size); });
    for (uint32_t partner = 0; partner < partners; ++partner) {
        static const Shared NOTHING;
        PerLane<const float*> lines;
        lines.fill(&NOTHING.position.x);
        PerLane<bool> asks{};
        for_lanes(on, [&](int i) {
            if (partner >= paths_[first + i].size) return;
            const Shared& y = ys_[partner_of(first + i, partner)];
            asks[i] = y.exists > 0;
            if (asks[i]) lines[i] = &y.position.x;
        });
        LaneMask valid = mask_of(asks);
        if (!any(valid)) continue;
        const LineColumns y = columns_of(lines);
        const SurfacePointOf<Lanes> point{vector_at(y, 0), vector_at(y, 4), y[3]};
        const LaneVec3 to = point.position - hits.point.position;
        const Lanes distance2 = dot(to, to);
        const LaneVec3 wi = to * (1 / sqrt(distance2));
        // y is seen from the side that it was found from.
        const Lanes cos_y = -dot(wi, point.normal), cos_shading = -dot(wi, vector_at(y, 7));
        valid = valid && distance2 > 0 && cos_y > 0 && cos_shading > 0;
        const BsdfValueOf<Lanes> bsdf = hits.values(valid, wi);
        // A path whose throughput is 0 ends at x, so it has no density there.
        valid = valid && bsdf.pdf > 0 && !is_black(bsdf.f);
        if (!any(valid)) continue;
        if (partner > 0) valid = sees_each_other(context, first, hits.point, point, wi, valid);
        const Lanes share = bsdf_diffuse_shares(valid, y[14], y[13], cos_shading);
        const Lanes per_area = cos_y / distance2;
        const LaneVec3 value = bsdf.f * (abs(dot(wi, hits.frame.n)) * per_area * share);
        const Lanes density = bsdf.pdf * per_area;
        for_lanes(valid, [&](int i) { at(first + i, partner) = {value.lane(i), density[i]}; });
    }
}

LaneMask PathReuse::sees_each_other(LaneContext& context, size_t first, const SurfacePointOf<Lanes>& x,
                                    const SurfacePointOf<Lanes>& y, const LaneVec3& wi,
                                    const LaneMask& on) const {
    LightSampleOf<Lanes> target;
    target.wi = wi, target.point = y;
    const LaneRays rays = shadow_ray(x, target);
    context.rays += popcount(on);
    const LaneMask visible = on && !context.scene.occluded(rays, on);
    for_lanes(on, [&](int i) {
        Observer* const observer = paths_[first + i].observer;
        if (observer) observer->reuse_ray(ray_of(rays, i), visible[i]);
    });
    return visible;
}

void PathReuse::observe_beyond(LaneContext& context, const LaneMask& on, const PerLane<size_t>& samples) {
    if (!context.is_observed()) return;
    for_lanes(on, [&](int i) {
        Path& path = paths_[samples[i]];
        path.beyond = std::make_unique<Beyond>(path.observer);
        context.observe(i, path.beyond.get());
    });
}

void PathReuse::Beyond::tell(Observer& observer, const vec3& at_y, const vec3& beyond, bool borrowed) const {
    for (size_t i = 0; i < found_.size(); ++i) {
        Contribution found = found_[i];
        found.unweighted *= i < at_y_ ? at_y : beyond;
        found.borrowed = borrowed;
        if (!is_black(found.unweighted)) observer.contribution(found);
    }
}

}  // namespace etendue
