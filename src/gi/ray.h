// Rays, and where they start: off a surface by the rounding error of the point on it, not by an epsilon.
#pragma once

#include "gi/math.h"

namespace etendue {

struct Ray {
    vec3 origin;
    vec3 direction;          // unit, but for shadow rays, which span the distance
    float t_max = INFINITE;  // in lengths of `direction`
};

/// A point of a surface, and the surface's unit normal there.
struct SurfacePoint {
    vec3 position{0};
    vec3 normal{0, 0, 1};
    float reach = 0;  // how far along the normal the true point may be from this one, rounding included

    /// An origin for rays that leave towards `direction`: past the plane of every point that this one may
    /// stand for (pbrt 4th ed., 6.8.6), so at the scene's own scale, near or far from the world's origin.
    vec3 offset_towards(const vec3& direction) const {
        return position + std::copysign(reach, glm::dot(direction, normal)) * normal;
    }
};

}  // namespace etendue
