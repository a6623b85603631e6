// Several paths at once, each in a lane, which another path takes over as soon as it has ended.
#pragma once

#include "algorithms/lane_context.h"

namespace etendue {

/// What paths carry as they grow; an estimator adds what it needs besides.
struct LanePaths {
    LaneMask alive{false};
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

/// Follows the paths of all samples of a queue. `extend(context, paths)` grows those that are alive by an edge, and says
/// which of them still are. Returns how many rays were traced.
template <class Paths, class Extend>
uint64_t follow(const Scene& scene, SampleQueue& queue, const Extend& extend) {
    LaneContext context(scene);
    Paths paths;
    PerLane<size_t> sample{};  // whose path it is
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
                sample[i] = begun++;
                origins.set(i, next->ray.origin), directions.set(i, next->ray.direction);
                context.start(i, *next);
            });
            paths.start(mask_of(starts), origins.lanes(), directions.lanes());
        }
        const LaneMask before = paths.alive;
        if (!any(before)) return context.rays;
        extend(context, paths);
        for_lanes(before && !paths.alive, [&](int i) { queue.estimated(sample[i], paths.radiance.lane(i)); });
    }
}

}  // namespace etendue
