// Rays, and where they start: off a surface by the rounding error of the point on it, not by an epsilon.
#pragma once

#include "gi/math.h"

namespace etendue {

template <class F>
struct RayOf {
    Vec3<F> origin;
    Vec3<F> direction;   // unit, but for shadow rays, which span the distance
    F t_max = INFINITE;  // in lengths of `direction`
};
using Ray = RayOf<float>;

/// A point of a surface, and the surface's unit normal there.
template <class F>
struct SurfacePointOf {
    Vec3<F> position{0};
    Vec3<F> normal{0, 0, 1};
    F reach = 0;  // how far along the normal the true point may be from this one, rounding included

    /// An origin for rays that leave towards `direction`: past the plane of every point that this one may
    /// stand for (pbrt 4th ed., 6.8.6), so at the scene's own scale, near or far from the world's origin.
    Vec3<F> offset_towards(const Vec3<F>& direction) const {
        return position + copysign(reach, dot(direction, normal)) * normal;
    }
};
using SurfacePoint = SurfacePointOf<float>;

}  // namespace etendue
