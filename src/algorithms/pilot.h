// How noisy a scene is, and how many pixels had best share their paths: found by a few paths of its own, before a render.
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

/// What it tells.
struct Pilot {
    uint32_t sharing;         // a power of two up to PathReuse::MOST_PIXELS; 1 where sharing does not pay
    float luminance;          // of the picture, in the mean
    float relative_variance;  // of a sample of a pixel, shared like that, without the noisiest pixels
    float rays;               // a sample
};
/// Always the same for a scene and a camera. Without sharing where `may_share` is false. Empty where it was cut short.
std::optional<Pilot> fly(const Preparation& preparation, bool may_share, const TryReuse& try_reuse);

}  // namespace etendue
