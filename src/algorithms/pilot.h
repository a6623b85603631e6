// How noisy a scene is, and where its noise comes from, found by a few paths of its own before a render: how many pixels had best
// share their paths, and how many lights had best be sampled at the first surface of each path.
//
// Some groups of pixels are estimated with and without sharing, with one light and with several. With n pixels and m lights the
// variance is about  a + b / n + c / m:  b is of light that pixels might share, c of the lights that are sampled at what they
// see, a of the rest. Where its product with the time is least, noise falls fastest.
#pragma once

#include "algorithms/path_reuse.h"

namespace etendue {

/// What may be done for all paths of a queue together.
struct Together {
    bool shares;             // what they find, see path_reuse.h
    uint32_t light_samples;  // at each first surface, a power of two; 1: while the path is followed
};
/// Estimates of the samples of a queue, with and without sharing where it shares, and the rays that they took.
struct Trial {
    std::vector<PathReuse::Estimates> estimates;
    uint64_t rays = 0, rays_of_sharing = 0;
};
using Try = std::function<Trial(SampleQueue& queue, const Together& together)>;

/// What it tells.
struct Pilot {
    uint32_t sharing = 1;         // a power of two up to PathReuse::MOST_PIXELS; 1 where sharing does not pay
    uint32_t light_samples = 1;   // a power of two up to MOST_LIGHT_SAMPLES; 1 where more do not pay
    float luminance = 0;          // of the picture, in the mean
    float relative_variance = 0;  // of a sample of a pixel, by these, without the noisiest pixels
    float rays = 0;               // a sample
};
inline constexpr uint32_t MOST_LIGHT_SAMPLES = 4;

/// Always the same for a scene and a camera. Empty where it was cut short. `may_share`, `may_split`: else it is 1.
std::optional<Pilot> fly(const Preparation& preparation, bool may_share, bool may_split, const Try& attempt);

}  // namespace etendue
