// The camera ray of every sample: the same for the picture, its replays and what is recorded beside it.
#pragma once

#include "gi/camera.h"
#include "gi/filter.h"
#include "gi/sampler.h"

namespace etendue {

struct Sensor {
    Camera camera;
    Filter filter{Filter::Kind::blackman_harris};
    Sampler::Kind sampler = Sampler::Kind::sobol;
    uint64_t seed = 0;

    Sampler make_sampler() const { return {sampler, seed}; }

    /// Begins sample `index` of a pixel.
    Ray start(Sampler& numbers, uint32_t x, uint32_t y, uint64_t index) const {
        // By place on the film, so that a pixel's samples do not depend on the size of the image.
        numbers.start(y << 16 | x, index);
        const vec2 film = vec2(x, y) + 0.5f + filter.sample(numbers.next_2d());
        return camera.ray(film, numbers.next_2d());
    }
};

}  // namespace etendue
