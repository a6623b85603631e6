// What the sensor has gathered: exact sums a pixel, in double, so that a million samples lose no bits.
#pragma once

#include <vector>

#include "gi/math.h"

namespace etendue {

struct Pixel {
    glm::dvec3 sum{0};
    glm::dvec3 sum_squares{0};
    glm::dvec3 half_sum{0};  // of every other sample, by its index: what is left is a second estimate
    uint64_t count = 0;      // of samples taken
    uint64_t invalid = 0;    // of those, how many were no finite numbers >= 0 and are not in the sums

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
        if (index % 2 == 0) half_sum += r;
        return true;
    }

    vec3 mean() const { return count > invalid ? vec3(sum / static_cast<double>(count - invalid)) : vec3(0); }
};

class Film {
  public:
    Film(uint32_t width, uint32_t height) : width_(width), height_(height), pixels_(size_t{width} * height) {}

    Pixel& at(uint32_t x, uint32_t y) { return pixels_[size_t{y} * width_ + x]; }
    const std::vector<Pixel>& pixels() const { return pixels_; }
    uint32_t width() const { return width_; }
    uint32_t height() const { return height_; }

  private:
    uint32_t width_, height_;
    std::vector<Pixel> pixels_;  // rows from the top
};

}  // namespace etendue
