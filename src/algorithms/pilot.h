// How noisy a scene is, and where its noise comes from, found by a few paths of its own before a render: how many pixels had best
// share their paths, and how many lights had best be sampled at the first surface of each path.
//
// Some groups of pixels are estimated with and without sharing, with one light and with several. With n pixels and m lights the
// variance is about  a + b / w(n) + c / m:  b is of light that pixels might share, whose n paths are worth w(n) of a pixel's own,
// c of the lights that are sampled at what they see, a of the rest. Where its product with the time is least, noise falls
// fastest. A third trial tells what portals take away.
#pragma once

#include "algorithms/path_reuse.h"

namespace etendue {

/// What may be done for all paths of a queue together.
struct Together {
    bool shares;             // what they find, see path_reuse.h
    uint32_t light_samples;  // at each first surface, a power of two; 1: while the path is followed
    bool by_portals;         // whether directions to delta surfaces are sampled there too, see portals.h
};
/// Estimates of the samples of a queue, with and without sharing where it shares, and the rays that they took.
struct Trial {
    std::vector<PathReuse::Estimates> estimates;
    std::vector<vec3> portal_gains;  // where it uses portals, see Portals::Light
    uint64_t rays = 0, rays_of_sharing = 0;
};
using Try = std::function<Trial(SampleQueue& queue, const Together& together)>;

/// What it tells.
struct Pilot {
    uint32_t sharing = 1;         // a power of two up to PathReuse::MOST_PIXELS; 1 where sharing does not pay
    uint32_t light_samples = 1;   // a power of two up to MOST_LIGHT_SAMPLES; 1 where more do not pay
    bool by_portals = false;      // whether they pay
    float luminance = 0;          // of the picture, in the mean
    float relative_variance = 0;  // of a sample of a pixel, by these, without the noisiest pixels
    float rays = 0;               // a sample
};
inline constexpr uint32_t MOST_LIGHT_SAMPLES = 4;

/// With portals, where these pay, and without.
struct Pilots {
    Pilot best, without_portals;
};

/// What may be found best; else it is 1 or false.
struct Allowed {
    bool sharing, light_samples, portals;
};

/// Always the same for a scene and a camera. Empty where it was cut short.
std::optional<Pilots> fly(const Preparation& preparation, const Allowed& allowed, const Try& attempt);

}  // namespace etendue
