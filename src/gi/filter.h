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
    template <class V2>
    V2 sample(const V2& u) const {
        return {sample_1d(u.x), sample_1d(u.y)};
    }

    /// The density of `sample`, for an offset from a pixel's centre.
    float density(const vec2& offset) const { return density_1d(offset.x) * density_1d(offset.y); }
    /// Offsets are no longer than this along either axis.
    float radius() const { return kind_ == Kind::box ? 0.5f : distances_[0]; }

  private:
    float density_1d(float offset) const;

    static constexpr int CELLS = 256;

    template <class F>
    F sample_1d(const F& u) const {
        if (kind_ == Kind::box) return u - 0.5f;
        // The filter is even, and its tail beyond a distance is tabulated over its fourth root: in equal
        // shares of the whole the last cell would spread over a third of the radius.
        const F cell = sqrt(sqrt(2 * min(u, 1 - u))) * CELLS;
        const F i = min(floor(cell), F(CELLS - 1));
        const F low = distance_at(i);
        const F distance = low + (cell - i) * (distance_at(i + 1) - low);
        return select(u < 0.5f, -distance, distance);
    }
    float distance_at(float i) const { return distances_[static_cast<int>(i)]; }
    Lanes distance_at(const Lanes& i) const {
        const PerLane<float> all = to_array(i);
        return lanes_of([&](size_t lane) { return distance_at(all[lane]); });
    }

    Kind kind_;
    // From the centre along one axis, to where the share (i / CELLS)^4 of a half is left beyond.
    std::array<float, CELLS + 1> distances_{};
};

}  // namespace etendue
