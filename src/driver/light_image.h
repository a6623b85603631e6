// What an estimator's paths from lights bring to the film, sample by sample: see Algorithm::light_paths.
//
// They land anywhere, so they are traced before the samples of pixels which they belong to, for the whole image at once.
#pragma once

#include <span>
#include <vector>

#include "algorithms/algorithm.h"
#include "driver/sensor.h"
#include "driver/tiles.h"

namespace etendue {

class LightImage {
  public:
    LightImage(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm)
        : scene_(scene), sensor_(sensor), algorithm_(algorithm) {}

    /// How many samples are traced at once at most, so that few are kept.
    static constexpr uint64_t MOST_SAMPLES = 16;

    /// Traces what belongs to samples [begin, end), and forgets all others. `observe(part)`, where given, is told of the rays of
    /// a part of the paths. False, with nothing known, where `stop` became true meanwhile.
    bool trace(TileWorkers& workers, uint64_t begin, uint64_t end, const std::atomic<bool>& stop,
               const std::function<Observer*()>& observe = {});

    /// What lands on a pixel in one of these samples.
    std::span<const Contribution> at(uint32_t x, uint32_t y, uint64_t index) const;
    /// Whether anything lands anywhere.
    bool is_empty() const { return samples_.empty(); }

    /// That were traced.
    uint64_t rays() const { return rays_; }

  private:
    /// Of a sample of the whole image: contributions by pixel, and where those of each row and pixel are.
    struct SampleImage {
        std::vector<uint32_t> pixels;
        std::vector<Contribution> found;
        std::vector<uint32_t> rows;
    };
    struct Landed {
        uint32_t pixel;
        Contribution found;
    };
    std::vector<Landed> trace_part(uint64_t sample, uint32_t first_path, uint32_t paths, Observer* observer);
    /// On all pixels whose filter sees the place.
    void land(const Splat& splat, std::vector<Landed>& all) const;
    SampleImage sorted(std::span<const std::vector<Landed>> parts) const;

    const Scene& scene_;
    const Sensor& sensor_;
    const Algorithm& algorithm_;
    uint64_t first_ = 0;
    std::vector<SampleImage> samples_;
    std::atomic<uint64_t> rays_ = 0;
};

}  // namespace etendue
