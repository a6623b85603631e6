// Rays, and where they start: off a surface by the rounding error of the point on it, not by an epsilon.
#pragma once

#include <bit>

#include "gi/math.h"

namespace etendue {

struct Ray {
    vec3 origin;
    vec3 direction;          // unit, but for shadow rays, which span the distance
    float t_max = INFINITE;  // in lengths of `direction`
};

/// A point with a bound on the absolute error of each coordinate, and the unit normal of the surface it is
/// on.
struct SurfacePoint {
    vec3 position{0};
    vec3 error{0};
    vec3 normal{0, 0, 1};

    /// An origin for rays that leave towards `direction`: past the plane of every point that this one may
    /// stand for (pbrt 4th ed., 6.8.6), so at the scene's own scale, near or far from the world's origin.
    vec3 offset_towards(const vec3& direction) const {
        const float reach = glm::dot(glm::abs(normal), error);
        const float side = glm::dot(direction, normal) < 0 ? -reach : reach;
        vec3 origin = position + side * normal;
        for (int i = 0; i < 3; ++i) origin[i] = next_away(origin[i], side * normal[i]);
        return origin;
    }

  private:
    /// The neighbouring float in the direction of the sign of `step`, as the sum above was itself rounded.
    static float next_away(float x, float step) {
        if (step == 0) return x;
        if (x == 0) return std::copysign(std::numeric_limits<float>::min(), step);
        const auto bits = std::bit_cast<int32_t>(x);
        return std::bit_cast<float>(bits + ((step > 0) == (x > 0) ? 1 : -1));
    }
};

}  // namespace etendue
