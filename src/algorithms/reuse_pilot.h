// How many pixels had best share their paths in a scene: found by a few paths of its own, before a render.
//
// Some groups of pixels are estimated with and without sharing, which tells how much variance and how many rays it makes
// of theirs. With n pixels the variance is about  a + b / n:  a of light that pixels see directly, and of what they see
// unlike each other. Where its product with the time is least, noise falls fastest.
#pragma once

#include "algorithms/path_reuse.h"

namespace etendue {

/// Traces the paths of a queue, shares them, and tells of both estimates of each, and of the rays of both.
struct ReuseTrial {
    std::vector<PathReuse::Estimates> estimates;
    uint64_t rays = 0, rays_of_sharing = 0;
};
using TryReuse = std::function<ReuseTrial(SampleQueue& queue)>;

/// A power of two up to PathReuse::MOST_PIXELS; 1 where sharing does not pay. Always the same for a scene and a camera. Empty
/// where it was cut short.
std::optional<uint32_t> best_sharing(const Preparation& preparation, const TryReuse& try_reuse);

}  // namespace etendue
