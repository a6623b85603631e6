// The first surfaces that the paths of a queue see, kept until all paths have ended: what is done there in lanes is done for as
// many as there are, while of paths that are being followed few are at their first surface at a time.
#pragma once

#include <vector>

#include "algorithms/lane_context.h"

namespace etendue {

class FirstSurfaces {
  public:
    FirstSurfaces() { seen_.reserve(QUEUE_SAMPLES); }

    /// A sample's path begins, the next of the queue.
    void begin(const CameraSample& sample) { seen_.push_back({.sample = sample}); }

    /// What paths see first, those that are `on`; `samples`: whose paths they are.
    void add(const LaneMask& on, const PerLane<size_t>& samples, const SurfaceHits& hits) {
        for_lanes(on, [&](int i) {
            Seen& seen = seen_[samples[i]];
            seen.part = hits.found.part[i];
            seen.triangle = hits.found.triangle[i];
            seen.barycentrics = hits.found.barycentrics(i);
            seen.distance = hits.found.distance[i];
        });
    }

    /// Of paths.
    size_t count() const { return seen_.size(); }
    const CameraSample& sample(size_t path) const { return seen_[path].sample; }

    /// Calls visit(first, on, hits) for the paths from `first` on, as many as there are lanes, and what those of them see that
    /// are `on`.
    void for_each(const auto& visit) const {
        for (size_t first = 0; first < seen_.size(); first += LANES) {
            VectorArrays origins, directions;
            FoundHits found;
            PerLane<bool> sees{};
            for (size_t i = 0; i < LANES && first + i < seen_.size(); ++i) {
                const Seen& seen = seen_[first + i];
                sees[i] = seen.part != nullptr;
                origins.set(i, seen.sample.ray.origin), directions.set(i, seen.sample.ray.direction);
                found.part[i] = seen.part, found.triangle[i] = seen.triangle;
                found.distance[i] = seen.distance;
                found.b1[i] = seen.barycentrics.x, found.b2[i] = seen.barycentrics.y;
            }
            const LaneMask on = mask_of(sees);
            if (!any(on)) continue;
            SurfaceHits hits({origins.lanes(), directions.lanes()}, on, found);
            hits.read_colours();
            visit(first, on, hits);
        }
    }

  private:
    struct Seen {
        CameraSample sample;
        const ScenePart* part = nullptr;  // null where nothing is to be done
        uint32_t triangle = 0;
        vec2 barycentrics{0};
        float distance = 0;
    };
    std::vector<Seen> seen_;
};

}  // namespace etendue
