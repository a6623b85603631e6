// Samples of pixels, as an estimator takes them: given out in order, estimated in any order, looked at in order again.
#pragma once

#include <atomic>
#include <vector>

#include "algorithms/algorithm.h"
#include "driver/light_image.h"
#include "driver/pixel_groups.h"

namespace etendue {

/// `Listener`: an Observer for each sample.
template <class Listener>
class SampleBatch : public SampleQueue {
  public:
    using Place = PixelGroups::Place;
    struct Sample {
        uint32_t x, y;
        uint64_t index;
        bool shares;     // paths with the sample before
        bool is_wanted;  // else it is there for those that share its path
        vec3 radiance;
        Listener listener;
    };

    /// `light`: of all samples that will be asked for. Once `stop` is true, where there is one, no more samples are given out.
    SampleBatch(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, const LightImage& light,
                const std::atomic<bool>* stop = nullptr)
        : scene_(scene),
          sensor_(sensor),
          algorithm_(algorithm),
          light_(light),
          numbers_(sensor.make_sampler()),
          stop_(stop) {}

    /// Estimates samples [begin, end) of the pixels of a tile, those for which wanted(place, index), and calls visit(sample)
    /// for each, a pixel's in order, at the latest in `finish`. Where it was stopped the last ones are left out.
    void add(const Tile& tile, uint64_t begin, uint64_t end, const auto& wanted, const auto& visit) {
        while (begin < end && !is_stopped()) {
            const uint64_t block = begin / PixelGroups::BLOCK;
            const uint64_t stop = std::min(end, (block + 1) * PixelGroups::BLOCK);
            PixelGroups(tile, algorithm_.sharing(), block).for_each([&](const auto& places) {
                for (uint64_t index = begin; index < stop; ++index) {
                    add_group(places, index, [&](const Place& place) { return wanted(place, index); });
                    if (samples_.size() >= QUEUE_SAMPLES) finish(visit);
                }
            });
            begin = stop;
        }
    }
    /// One sample of one pixel of a tile, which `finish` visits.
    void add(const Tile& tile, uint32_t x, uint32_t y, uint64_t index) {
        const PixelGroups groups(tile, algorithm_.sharing(), index / PixelGroups::BLOCK);
        add_group(groups.of(x, y), index, [&](const Place& place) { return place.x == x && place.y == y; });
    }
    void finish(const auto& visit) {
        rays_ += algorithm_.estimate(scene_, *this);
        for (size_t i = 0; i < given_; ++i) {
            if (!samples_[i].is_wanted) continue;
            add_light(samples_[i]);
            visit(samples_[i]);
        }
        samples_.clear();
        given_ = 0;
    }

    /// That were traced.
    uint64_t rays() const { return rays_; }

    std::optional<CameraSample> next() override {
        // Groups are estimated whole or not at all.
        if (given_ == samples_.size() || (is_stopped() && !samples_[given_].shares)) return std::nullopt;
        if (given_ % LANES == 0) make_rays();
        const size_t i = given_ % LANES;
        Sample& sample = samples_[given_++];
        Observer* observer = nullptr;
        if constexpr (std::derived_from<Listener, Observer>) observer = &sample.listener;
        return CameraSample{rays_of_[i], streams_[i], observer, sample.shares};
    }
    void estimated(size_t sample, const vec3& radiance) override { samples_[sample].radiance = radiance; }

  private:
    bool is_stopped() const { return stop_ && *stop_; }
    void add_group(std::span<const Place> places, uint64_t index, const auto& wanted) {
        if (std::ranges::none_of(places, wanted)) return;
        bool shares = false;
        for (const Place& place : places) {
            samples_.push_back({place.x, place.y, index, shares, wanted(place), vec3(0), {}});
            shares = true;
        }
    }
    void add_light(Sample& sample) const {
        light_.for_each(sample.x, sample.y, sample.index, [&](const Contribution& found) {
            sample.radiance += found.unweighted * found.weight;
            if constexpr (std::derived_from<Listener, Observer>) sample.listener.contribution(found);
        });
    }
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
        for (int i = 0; i < LANES; ++i) rays_of_[i] = {rays.origin.lane(i), rays.direction.lane(i)};
    }

    const Scene& scene_;
    const Sensor& sensor_;
    const Algorithm& algorithm_;
    const LightImage& light_;
    Sampler numbers_;
    const std::atomic<bool>* stop_;
    std::vector<Sample> samples_;
    size_t given_ = 0;
    uint64_t rays_ = 0;
    PerLane<Ray> rays_of_{};
    PerLane<Sampler::Stream> streams_{};
};

/// For `add`.
inline constexpr auto EVERY_SAMPLE = [](const PixelGroups::Place&, uint64_t) { return true; };

/// Where nobody listens.
struct Unobserved {};

}  // namespace etendue
