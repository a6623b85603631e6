// Several paths at once, each in a lane, which another path takes over as soon as it has ended.
#pragma once

#include "algorithms/lane_context.h"

namespace etendue {

/// What paths carry as they grow; an estimator adds what it needs besides.
struct LanePaths {
    LaneMask alive{false};
    PerLane<size_t> sample{};  // whose path it is, counted as in the queue
    LaneRays rays;
    Lanes edges = 1;  // the path's length with the ray that is to be traced next
    LaneVec3 radiance, throughput;
    Lanes eta_scale = 1;  // see RussianRoulette

    /// New paths begin in the lanes that are `on`.
    void start(const LaneMask& on, const LaneVec3& origins, const LaneVec3& directions) {
        rays.origin = select(on, origins, rays.origin);
        rays.direction = select(on, directions, rays.direction);
        edges = select(on, Lanes(1), edges);
        radiance = select(on, LaneVec3(0), radiance);
        throughput = select(on, LaneVec3(1), throughput);
        eta_scale = select(on, Lanes(1), eta_scale);
        alive = alive || on;
    }
};

/// Follows the paths of all samples of a queue. `extend(paths)` grows those that are alive by an edge, and says which of them
/// still are; `begin(sample)` and `end(index, radiance)` are told of each.
template <class Paths>
void follow(LaneContext& context, SampleQueue& queue, const auto& begin, const auto& extend,
            const auto& end) {
    Paths paths;
    size_t begun = 0;
    bool is_empty = false;
    for (;;) {
        if (!is_empty && !all_of(paths.alive)) {
            PerLane<bool> starts{};
            VectorArrays origins, directions;
            for_lanes(!paths.alive, [&](int i) {
                const auto next = is_empty ? std::nullopt : queue.next();
                is_empty = !next;
                if (is_empty) return;
                starts[i] = true;
                paths.sample[i] = begun++;
                begin(*next);
                origins.set(i, next->ray.origin), directions.set(i, next->ray.direction);
                context.start(i, *next);
            });
            paths.start(mask_of(starts), origins.lanes(), directions.lanes());
        }
        const LaneMask before = paths.alive;
        if (!any(before)) return;
        extend(paths);
        for_lanes(before && !paths.alive, [&](int i) { end(paths.sample[i], paths.radiance.lane(i)); });
    }
}

/// The same where a path's radiance is its sample's estimate. Returns how many rays were traced.
template <class Paths>
uint64_t follow(const Scene& scene, SampleQueue& queue, const auto& extend) {
    LaneContext context(scene);
    follow<Paths>(
        context, queue, [](const CameraSample&) {}, [&](Paths& paths) { extend(context, paths); },
        [&](size_t sample, const vec3& radiance) { queue.estimated(sample, radiance); });
    return context.rays;
}

}  // namespace etendue
