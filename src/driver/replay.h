// One sample's path again, written down vertex by vertex: for a sample that came out wrong, or a pixel that is
// noisy.
#pragma once

#include <optional>
#include <vector>

#include "algorithms/algorithm.h"
#include "driver/sensor.h"

namespace etendue {

/// The end of one edge, and what the estimator did there.
struct PathVertex {
    struct Roulette {
        float q;  // probability of ending the path
        bool survived;
    };
    struct ShadowRay {
        Ray ray;  // spans the distance to the light: t_max is about 1
        bool visible;
    };

    Ray ray;  // that led here
    SurfaceHit hit;
    vec3 throughput;  // of the path when it came here
    std::optional<BsdfSample> bounce;
    std::optional<Roulette> roulette;
    std::vector<ShadowRay> shadow_rays;
    std::vector<Contribution> contributions;
};

struct PathRecord {
    std::vector<PathVertex> vertices;
    std::vector<Contribution> borrowed;     // that other pixels' paths found and shared
    std::vector<Contribution> from_lights;  // that paths from lights brought
    std::vector<Contribution> by_portals;   // that were found beside the path, through glass and over mirrors
    vec3 radiance{0};                       // the estimate
};

/// The same path as sample `index` of that pixel in any render with these settings. `with_lights`: and what paths from lights
/// bring to it, for which those of the whole image are traced.
PathRecord replay(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, uint32_t x,
                  uint32_t y, uint64_t index, bool with_lights, int threads);

}  // namespace etendue
