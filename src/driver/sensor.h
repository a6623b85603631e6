// The camera ray of every sample: the same for the picture, its replays and what is recorded beside it.
#pragma once

#include "gi/camera.h"
#include "gi/filter.h"
#include "gi/lane_sampler.h"

namespace etendue {

struct Sensor {
    Camera camera;
    Filter filter{Filter::Kind::blackman_harris};
    Sampler::Kind sampler = Sampler::Kind::sobol;
    uint64_t seed = 0;

    Sampler make_sampler() const { return {sampler, seed}; }

    /// Begins sample `index` of a pixel.
    Ray start(Sampler& numbers, uint32_t x, uint32_t y, uint64_t index) const {
        numbers.start(stream(numbers, x, y, index));
        const vec2 u = numbers.next_2d();
        return ray(vec2(x, y), u, numbers.next_2d());
    }
    static Sampler::Stream stream(const Sampler& numbers, uint32_t x, uint32_t y, uint64_t index) {
        // By place on the film, so that a pixel's samples do not depend on the size of the image.
        return numbers.stream(y << 16 | x, index);
    }
    /// By a pixel and numbers for the filter and for the lens.
    template <class V2>
    RayOf<NumberOf<V2>> ray(const V2& pixel, const V2& u_filter, const V2& u_lens) const {
        const V2 offset = filter.sample(u_filter);
        return camera.ray(V2(pixel.x + 0.5f + offset.x, pixel.y + 0.5f + offset.y), u_lens);
    }
};

}  // namespace etendue
