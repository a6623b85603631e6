// Russian roulette (assignment 3): ends paths that carry little, and weights the survivors so that the mean
// stays.
//
// The operator of the sheet with c = 0: the throughput F becomes F / (1 - q) with probability 1 - q, else 0.
// Its expectation is F whatever q is, so the settings move noise and time, never the picture.
//
// q = 1 - (largest component of F) / RR_THRESHOLD.  A survivor then carries just the threshold: at the
// threshold itself nothing changes, and no path is ever made brighter than one that was not played for.
#pragma once

#include "algorithms/algorithm.h"

namespace etendue {

class RussianRoulette {
  public:
    explicit RussianRoulette(const Parameters& parameters)
        : RR_MIN_PATH_LENGTH(static_cast<float>(parameters.get<int>("rr_min_path_length"))),
          RR_THRESHOLD(static_cast<float>(parameters.get<double>("rr_threshold"))) {}

    /// Plays after bounce number `bounces` with the paths that are `on`. False: a path ends here. `scale` makes what a path
    /// carries of its throughput: it undoes the compression of radiance in glass, which comes back when the path leaves it
    /// (pbrt 4th ed., 13.2.1).
    template <class Context, class F>
    Mask<F> survives(Context& context, Vec3<F>& throughput, const F& scale, const F& bounces,
                     const Mask<F>& on) const {
        const F carried = max_component(throughput) * scale;
        const Mask<F> plays = on && bounces > RR_MIN_PATH_LENGTH && carried < RR_THRESHOLD;
        if (!any(plays)) return on;
        const F q = 1 - carried / RR_THRESHOLD;
        const Mask<F> survives = on && context.roulette(q, plays);
        throughput = select(plays, throughput / (1 - q), throughput);
        return survives;
    }

    static std::vector<Parameter> parameters() {
        return {
            {"rr_min_path_length", "bounces before Russian roulette may act", 1, 0, 1'000'000, {}},
            {"rr_threshold", "roulette acts where the throughput is below this; 0: never", 0.25, 0, 1e6, {}}};
    }

  private:
    const float RR_MIN_PATH_LENGTH, RR_THRESHOLD;
};

}  // namespace etendue
