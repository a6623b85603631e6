// The pixel filter, by importance sampling: a sample's film position is drawn with the filter as its density,
// so that every sample counts alike and belongs to one pixel (Ernst et al. 2006, "Filter Importance
// Sampling").
#pragma once

#include <array>
#include <string_view>

#include "gi/math.h"

namespace etendue {

class Filter {
  public:
    enum class Kind : uint8_t { blackman_harris, box };
    static constexpr std::array<std::string_view, 2> names{"blackman_harris", "box"};

    explicit Filter(Kind kind);

    /// Offset from the pixel's centre, in pixels.
    vec2 sample(const vec2& u) const { return {sample_1d(u.x), sample_1d(u.y)}; }

  private:
    static constexpr int CELLS = 256;

    float sample_1d(float u) const {
        const float cell = u * CELLS;
        const int i = static_cast<int>(cell);
        return quantiles_[i] + (cell - static_cast<float>(i)) * (quantiles_[i + 1] - quantiles_[i]);
    }

    std::array<float, CELLS + 1> quantiles_;  // of the filter along one axis
};

}  // namespace etendue
