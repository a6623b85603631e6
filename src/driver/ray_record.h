// The rays that a render traces, kept so that nothing but their tracing can be timed: the limit that an estimator
// is held against.
#pragma once

#include "algorithms/algorithm.h"
#include "driver/sensor.h"

namespace etendue {

class RayRecord {
  public:
    /// Renders samples [0, samples) of every pixel and keeps their rays, 32 bytes each, path by path within a tile, which
    /// is the order in which they are traced fastest. The scene must outlive the record.
    RayRecord(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, uint64_t samples,
              int threads);

    /// Traces them all again, and nothing else. Returns how many hit something, for a check.
    uint64_t replay(int threads) const;

    uint64_t rays() const;

  private:
    const Scene& scene_;
    uint32_t width_, height_;
    std::vector<std::vector<TracedRay>> tiles_;
};

}  // namespace etendue
