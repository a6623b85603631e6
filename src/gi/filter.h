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
        if (kind_ == Kind::box) return u - 0.5f;
        // The filter is even, and its tail beyond a distance is tabulated over its fourth root: in equal
        // shares of the whole the last cell would spread over a third of the radius.
        const float cell = std::sqrt(std::sqrt(2 * std::min(u, 1 - u))) * CELLS;
        const int i = std::min(static_cast<int>(cell), CELLS - 1);
        const float distance =
            distances_[i] + (cell - static_cast<float>(i)) * (distances_[i + 1] - distances_[i]);
        return u < 0.5f ? -distance : distance;
    }

    Kind kind_;
    // From the centre along one axis, to where the share (i / CELLS)^4 of a half is left beyond.
    std::array<float, CELLS + 1> distances_{};
};

}  // namespace etendue
