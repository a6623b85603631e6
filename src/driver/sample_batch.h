// Samples of pixels, as an estimator takes them: given out in order, estimated in any order, looked at in order again.
#pragma once

#include <atomic>
#include <vector>

#include "algorithms/algorithm.h"
#include "driver/sensor.h"

namespace etendue {

/// `Listener`: an Observer for each sample.
template <class Listener>
class SampleBatch : public SampleQueue {
  public:
    struct Sample {
        uint32_t x, y;
        uint64_t index;
        vec3 radiance;
        Listener listener;
    };

    /// As many as are estimated between two looks at them: enough for lanes to be full most of the time.
    static constexpr size_t CAPACITY = 4096;

    /// Once `stop` is true, where there is one, no more samples are given out.
    explicit SampleBatch(const Sensor& sensor, const std::atomic<bool>* stop = nullptr)
        : sensor_(sensor), numbers_(sensor.make_sampler()), stop_(stop) {}

    bool is_full() const { return samples_.size() >= CAPACITY; }
    void add(uint32_t x, uint32_t y, uint64_t index, Listener listener = {}) {
        samples_.push_back({x, y, index, vec3(0), std::move(listener)});
    }

    /// Estimates what has been added, and calls visit(sample) for each, in the order in which they were. Where it was
    /// stopped the last ones are left out. Returns how many rays were traced.
    template <class Visit>
    uint64_t estimate(const Algorithm& algorithm, const Scene& scene, const Visit& visit) {
        const uint64_t rays = algorithm.estimate(scene, *this);
        for (size_t i = 0; i < given_; ++i) visit(samples_[i]);
        samples_.clear();
        given_ = 0;
        return rays;
    }

    std::optional<CameraSample> next() override {
        if (given_ == samples_.size() || (stop_ && *stop_)) return std::nullopt;
        if (given_ % LANES == 0) make_rays();
        const size_t i = given_ % LANES;
        Observer* observer = nullptr;
        if constexpr (std::derived_from<Listener, Observer>) observer = &samples_[given_].listener;
        ++given_;
        return CameraSample{rays_[i], streams_[i], observer};
    }
    void estimated(size_t sample, const vec3& radiance) override { samples_[sample].radiance = radiance; }

  private:
    /// Of the next samples, as many as there are lanes.
    void make_rays() {
        LaneSampler numbers;
        PerLane<float> x{}, y{};
        for (size_t i = 0; i < LANES && given_ + i < samples_.size(); ++i) {
            const Sample& sample = samples_[given_ + i];
            x[i] = static_cast<float>(sample.x), y[i] = static_cast<float>(sample.y);
            streams_[i] = Sensor::stream(numbers_, sample.x, sample.y, sample.index);
            numbers.start(static_cast<int>(i), streams_[i]);
        }
        numbers.start_vertex(0);
        const LaneVec2 u = numbers.next_2d(LaneMask(true));
        const LaneRays rays =
            sensor_.ray(LaneVec2{lanes_of(x), lanes_of(y)}, u, numbers.next_2d(LaneMask(true)));
        for (int i = 0; i < LANES; ++i) rays_[i] = {rays.origin.lane(i), rays.direction.lane(i)};
    }

    const Sensor& sensor_;
    Sampler numbers_;
    const std::atomic<bool>* stop_;
    std::vector<Sample> samples_;
    size_t given_ = 0;
    PerLane<Ray> rays_{};
    PerLane<Sampler::Stream> streams_{};
};

/// Where nobody listens.
struct Unobserved {};

}  // namespace etendue
