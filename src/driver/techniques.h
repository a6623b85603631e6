// The picture split by how its light was found: by technique and path length, before and after the weights of
// multiple importance sampling (the pyramid of Veach 1997, figure 10.2, for two techniques).
#pragma once

#include <atomic>

#include "algorithms/algorithm.h"
#include "driver/sensor.h"

namespace etendue {

class TechniqueFilm {
  public:
    /// Whether a value has its MIS weight, or is what the technique alone would have found.
    enum Weighting : uint8_t { weighted, unweighted };

    /// Sums over the samples of one pixel, for one technique and path length.
    struct Sums {
        glm::dvec3 sum{0}, sum_squares{0};
    };

    /// All must outlive this. Paths longer than `max_edges` are counted there.
    TechniqueFilm(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, int max_edges,
                  int threads);

    /// Takes `samples` samples more of every pixel. False where `cancel` stopped it, between pixels.
    bool render(uint64_t samples);
    /// Makes the running `render`, or else the next, return soon. From any thread.
    void cancel() { stop_ = true; }

    const Sums& at(Weighting weighting, Technique technique, int edges, uint32_t x, uint32_t y) const {
        return sums_[slot(pixel(x, y), weighting, technique, edges)];
    }
    uint64_t samples() const { return samples_; }
    /// Of all pixels, by the running or last `render`.
    uint64_t samples_done() const { return samples_done_; }
    uint32_t width() const { return sensor_.camera.width(); }
    uint32_t height() const { return sensor_.camera.height(); }
    int max_edges() const { return max_edges_; }

  private:
    size_t pixel(uint32_t x, uint32_t y) const { return size_t{y} * width() + x; }
    size_t slots() const { return 2 * TECHNIQUES.size() * max_edges_; }
    size_t slot(size_t pixel, Weighting weighting, Technique technique, int edges) const {
        const size_t column = weighting * TECHNIQUES.size() + static_cast<size_t>(technique);
        return pixel * slots() + column * max_edges_ + edges - 1;
    }

    const Scene& scene_;
    const Sensor& sensor_;
    const Algorithm& algorithm_;
    int max_edges_, threads_;
    std::vector<Sums> sums_;
    uint64_t samples_ = 0;
    std::atomic<uint64_t> samples_done_ = 0;
    std::atomic<bool> stop_ = false;
};

}  // namespace etendue
