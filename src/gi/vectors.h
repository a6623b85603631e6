// glm's vectors, and what goes with a type of number: see gi/lanes.h.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <glm/geometric.hpp>
#include <glm/vec2.hpp>
#include <glm/vec3.hpp>

namespace etendue {

using glm::vec2;
using glm::vec3;

// Of floats; those of Lanes are found by their types.
using std::abs;
using std::copysign;
using std::exp;
using std::exp2;
using std::expm1;
using std::floor;
using std::log1p;
using std::max;
using std::min;
using std::sqrt;

template <class F>
struct NumberTypes;
template <>
struct NumberTypes<float> {
    using Mask = bool;
    using Vec2 = vec2;
    using Vec3 = vec3;
};
/// The truth values and vectors of a type of number.
template <class F>
using Mask = typename NumberTypes<F>::Mask;
template <class F>
using Vec2 = typename NumberTypes<F>::Vec2;
template <class F>
using Vec3 = typename NumberTypes<F>::Vec3;
/// The type of a vector's numbers.
template <class V>
using NumberOf = std::remove_cvref_t<decltype(V::x)>;

template <class T>
T select(bool mask, const T& yes, const T& no) {
    return mask ? yes : no;
}
inline bool any(bool mask) { return mask; }

}  // namespace etendue
