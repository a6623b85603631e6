// What is seen in a pixel beside its radiance: of the first samples that the picture takes, by the same
// camera rays, averaged as the picture is.
#pragma once

#include <atomic>
#include <vector>

#include "driver/sensor.h"
#include "driver/tiles.h"
#include "gi/scene.h"

namespace etendue {

class Context;

/// The value that more than half of the added ones are, if there is one; else one of them (Boyer and Moore
/// 1991, "MJRTY").
struct Majority {
    int32_t value = -1;
    uint32_t lead = 0;

    void add(int32_t v) {
        if (lead == 0) value = v;
        lead += v == value ? 1 : -1;
    }
};

/// Sums over the samples of a pixel.
struct AovPixel {
    glm::dvec3 albedo{0}, normal{0}, position{0}, denoising_albedo{0}, denoising_normal{0};
    double depth = 0;
    Majority object, material;     // indices of the scene; -1: nothing
    uint64_t count = 0, hits = 0;  // samples, and those of them whose camera ray hit a surface
};

class AovPass {
  public:
    /// The scene must outlive the pass.
    AovPass(const Scene& scene, const Sensor& sensor, int threads);

    /// Adds the samples [first, first + samples) of every pixel. False where it was cancelled before that.
    bool render(uint64_t first, uint64_t samples);
    /// Makes the running `render`, or else the next, return within a few milliseconds. From any thread.
    void cancel() { stop_ = true; }
    /// Of the running or last `render`: the part of its tiles that is done (0..1).
    double done() const { return static_cast<double>(tiles_done_) / Tiles(width(), height()).count(); }

    uint32_t width() const { return sensor_.camera.width(); }
    uint32_t height() const { return sensor_.camera.height(); }
    const std::vector<AovPixel>& pixels() const { return pixels_; }  // rows from the top

  private:
    void add(Context& context, AovPixel& pixel, const Ray& ray) const;
    void add_guides(Context& context, AovPixel& pixel, SurfaceHit hit) const;

    const Scene& scene_;
    Sensor sensor_;
    int threads_;
    std::vector<AovPixel> pixels_;
    std::atomic<bool> stop_ = false;
    std::atomic<uint32_t> tiles_done_ = 0;
};

}  // namespace etendue
