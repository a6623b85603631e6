// What an estimator works with that follows several paths at once: as Context, which is for one path.
#pragma once

#include "algorithms/algorithm.h"
#include "gi/lane_sampler.h"

namespace etendue {

class LaneContext {
  public:
    explicit LaneContext(const Scene& scene) : scene(scene) {}

    /// A lane goes on with another sample.
    void start(int lane, const CameraSample& sample) {
        sampler.start(lane, sample.numbers);
        observers_[lane] = sample.observer;
        is_observed_ = is_observed_ || sample.observer;
    }

    /// A lane, which is free, goes back to the first surface of a sample's path, with other numbers.
    void start_at_first(int lane, const CameraSample& sample, const Sampler::Stream& numbers) {
        sampler.start(lane, numbers);
        observers_[lane] = sample.observer;
        if (sample.observer) sample.observer->back_at_first();
    }

    bool is_observed() const { return is_observed_; }
    /// Who listens to a lane's path from now on.
    void observe(int lane, Observer* observer) { observers_[lane] = observer; }

    /// What the next edges of the paths that are `on` end at. `meanwhile`: what else is to be done, once the rays are
    /// traced and what is known of the surfaces that they hit comes from memory.
    template <class Work>
    SurfaceHits intersect(const LaneRays& lane_rays, const LaneMask& on, const Work& meanwhile) {
        rays += popcount(on);
        const SurfaceHits hits = scene.intersect(lane_rays, on, meanwhile);
        if (is_observed_) tell_edges(lane_rays, on, hits);
        return hits;
    }
    /// The same beside the paths, whose edges these are not.
    SurfaceHits intersect_aside(const LaneRays& lane_rays, const LaneMask& on) {
        rays += popcount(on);
        if (is_observed_) tell_portal_rays(lane_rays, on);
        return scene.intersect(lane_rays, on, [] {});
    }
    LaneMask visible(const LaneRays& lane_rays, const LaneMask& on) {
        rays += popcount(on);
        const LaneMask visible = on && !scene.occluded(lane_rays, on);
        if (is_observed_) tell_shadow_rays(lane_rays, on, visible);
        return visible;
    }
    /// Directions to go on in, by the BSDF; there are none on a lamp, which absorbs.
    BsdfSampleOf<Lanes> bounce(const SurfaceHits& hits, const LaneMask& on) {
        const Lanes lobe = sampler.next_1d(on);
        const BsdfSampleOf<Lanes> samples = hits.sample(on, lobe, sampler.next_2d(on));
        if (is_observed_) tell_bounces(samples, on);
        return samples;
    }
    /// Ends each path that plays with probability q; the caller divides the throughput of survivors by 1 - q.
    LaneMask roulette(const Lanes& q, const LaneMask& plays) {
        const LaneMask survives = !plays || sampler.next_1d(plays) >= q;
        if (is_observed_) tell_roulette(q, plays, survives);
        return survives;
    }
    /// The radiance that light which was found by the paths that are `on` adds to their estimates.
    LaneVec3 light(const ContributionOf<Lanes>& found, const LaneMask& on) {
        if (is_observed_) tell_contributions(found, on);
        return select(on, found.unweighted * found.weight, LaneVec3(0));
    }

    const Scene& scene;
    LaneSampler sampler;
    uint64_t rays = 0;

  private:
    void tell_edges(const LaneRays& rays, const LaneMask& on, const SurfaceHits& hits);
    void tell_portal_rays(const LaneRays& rays, const LaneMask& on);
    void tell_shadow_rays(const LaneRays& rays, const LaneMask& on, const LaneMask& visible);
    void tell_bounces(const BsdfSampleOf<Lanes>& samples, const LaneMask& on);
    void tell_roulette(const Lanes& q, const LaneMask& plays, const LaneMask& survives);
    void tell_contributions(const ContributionOf<Lanes>& found, const LaneMask& on);
    /// Calls tell(observer, lane) for those that are `on` and observed.
    template <class Tell>
    void tell_each(const LaneMask& on, const Tell& tell) const {
        for_lanes(on, [&](int i) {
            if (observers_[i]) tell(*observers_[i], i);
        });
    }

    PerLane<Observer*> observers_{};
    bool is_observed_ = false;
};

}  // namespace etendue
