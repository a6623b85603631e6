// What the sensor has gathered: exact sums a pixel, in double, so that a million samples lose no bits.
#pragma once

#include <algorithm>
#include <bit>
#include <vector>

#include "gi/math.h"

namespace etendue {

/// Whether a sample belongs to the half of a pixel's samples that is summed up apart: the first 8 of 16, and
/// the first half of each further octave [2^k, 2^(k + 1)), the largest blocks that keep both halves alike at
/// every count from 16 on. As whole blocks of Sobol's sequence they are stratified, and differ by little more
/// than the error of their mean; samples of even and odd index would differ by more than unstratified ones.
constexpr bool in_half(uint64_t index) {
    const int bit = std::max(3, static_cast<int>(std::bit_width(index)) - 2);
    return (index >> bit & 1) == 0;
}

struct Pixel {
    glm::dvec3 sum{0};
    glm::dvec3 sum_squares{0};
    glm::dvec3 half_sum{0};   // of the samples in_half: what is left is a second estimate
    uint64_t count = 0;       // of samples taken
    uint64_t invalid = 0;     // of those, how many were no finite numbers >= 0 and are not in the sums
    uint64_t half_count = 0;  // samples in half_sum

    /// False where the sample is invalid.
    bool add(const vec3& radiance, uint64_t index) {
        ++count;
        if (!(radiance.x >= 0 && radiance.y >= 0 && radiance.z >= 0 && max_component(radiance) < INFINITE)) {
            ++invalid;
            return false;
        }
        const glm::dvec3 r(radiance);
        sum += r;
        sum_squares += r * r;
        if (in_half(index)) {
            half_sum += r;
            ++half_count;
        }
        return true;
    }

    vec3 mean() const { return count > invalid ? vec3(sum / static_cast<double>(count - invalid)) : vec3(0); }
};

class Film {
  public:
    Film(uint32_t width, uint32_t height) : width_(width), height_(height), pixels_(size_t{width} * height) {}

    Pixel& at(uint32_t x, uint32_t y) { return pixels_[size_t{y} * width_ + x]; }
    const Pixel& at(uint32_t x, uint32_t y) const { return pixels_[size_t{y} * width_ + x]; }
    const std::vector<Pixel>& pixels() const { return pixels_; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

  private:
    uint32_t width_, height_;
    std::vector<Pixel> pixels_;  // rows from the top
};

}  // namespace etendue
