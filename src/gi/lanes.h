// Several paths at once: numbers, vectors and truth values of one path each, in the lanes of vector registers.
//
// What is arithmetic alone (warps, BSDFs, pdfs) is written once, for a type of number F: float, or Lanes.  Where a float
// would branch, it has `select`, which takes the one or the other lane by lane.  A lane does what a float would, operation
// by operation, so the two come to the same bits, and so do registers of any width.
#pragma once

#include <array>
#include <bit>
#include <cmath>
#include <concepts>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <utility>

// GCC warns of its own header for AVX-512, which leaves a register as it is on purpose (its bug 105593).
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wuninitialized"
#pragma GCC diagnostic ignored "-Wmaybe-uninitialized"
#include <experimental/simd>
#pragma GCC diagnostic pop

#include "gi/vectors.h"

namespace etendue {

namespace simd = std::experimental;

// A call would have all registers saved around it: what is small is always inline, and some functions have all that they
// call inline, but for sanitizers, whose checks would make too much of them.
#define ETENDUE_LANES_INLINE [[gnu::always_inline]] inline
#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define ETENDUE_LANES_FLATTEN
#else
#define ETENDUE_LANES_FLATTEN [[gnu::flatten]]
#endif

using Lanes = simd::native_simd<float>;
using LaneMask = Lanes::mask_type;
using LaneBits = simd::rebind_simd_t<uint32_t, Lanes>;
inline constexpr int LANES = Lanes::size();

/// A value of any kind for each lane.
template <class T>
using PerLane = std::array<T, LANES>;

ETENDUE_LANES_INLINE Lanes select(const LaneMask& mask, const Lanes& yes, const Lanes& no) {
    Lanes out = no;
    where(mask, out) = yes;
    return out;
}
ETENDUE_LANES_INLINE LaneMask select(const LaneMask& mask, const LaneMask& yes, const LaneMask& no) {
    return (mask && yes) || (!mask && no);
}
ETENDUE_LANES_INLINE bool any(const LaneMask& mask) { return any_of(mask); }

ETENDUE_LANES_INLINE Lanes max(const Lanes& a, const Lanes& b) { return select(a < b, b, a); }
ETENDUE_LANES_INLINE Lanes min(const Lanes& a, const Lanes& b) { return select(b < a, b, a); }

/// A number for each lane, from get(lane).
template <class Get>
ETENDUE_LANES_INLINE Lanes lanes_of(const Get& get) {
    return Lanes([&](auto lane) { return get(static_cast<size_t>(lane)); });
}
ETENDUE_LANES_INLINE Lanes lanes_of(const PerLane<float>& values) {
    return Lanes(values.data(), simd::element_aligned);
}
ETENDUE_LANES_INLINE LaneMask mask_of(const PerLane<bool>& values) {
    return LaneMask(values.data(), simd::element_aligned);
}
ETENDUE_LANES_INLINE PerLane<float> to_array(const Lanes& values) {
    PerLane<float> out;
    values.copy_to(out.data(), simd::element_aligned);
    return out;
}
ETENDUE_LANES_INLINE PerLane<bool> to_array(const LaneMask& mask) {
    PerLane<bool> out;
    mask.copy_to(out.data(), simd::element_aligned);
    return out;
}

/// Calls work(lane) for those of the mask, in order.
template <class Work>
ETENDUE_LANES_INLINE void for_lanes(const LaneMask& mask, const Work& work) {
    const PerLane<bool> on = to_array(mask);
    for (int lane = 0; lane < LANES; ++lane) {
        if (on[lane]) work(lane);
    }
}

struct LaneVec2 {
    Lanes x = 0, y = 0;
};

struct LaneVec3 {
    Lanes x = 0, y = 0, z = 0;

    LaneVec3() = default;
    LaneVec3(const Lanes& x, const Lanes& y, const Lanes& z) : x(x), y(y), z(z) {}
    explicit LaneVec3(const Lanes& all) : x(all), y(all), z(all) {}
    explicit LaneVec3(float all) : x(all), y(all), z(all) {}
    explicit LaneVec3(const vec3& all) : x(all.x), y(all.y), z(all.z) {}

    vec3 lane(int i) const { return {x[i], y[i], z[i]}; }
    LaneVec3& operator+=(const LaneVec3& b) { return *this = {x + b.x, y + b.y, z + b.z}; }
    LaneVec3& operator*=(const LaneVec3& b) { return *this = {x * b.x, y * b.y, z * b.z}; }
};

ETENDUE_LANES_INLINE LaneVec3 operator-(const LaneVec3& a) { return {-a.x, -a.y, -a.z}; }
ETENDUE_LANES_INLINE LaneVec3 operator+(const LaneVec3& a, const LaneVec3& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
}
ETENDUE_LANES_INLINE LaneVec3 operator-(const LaneVec3& a, const LaneVec3& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
}
ETENDUE_LANES_INLINE LaneVec3 operator*(const LaneVec3& a, const LaneVec3& b) {
    return {a.x * b.x, a.y * b.y, a.z * b.z};
}
ETENDUE_LANES_INLINE LaneVec3 operator*(const LaneVec3& a, const Lanes& b) {
    return {a.x * b, a.y * b, a.z * b};
}
ETENDUE_LANES_INLINE LaneVec3 operator*(const Lanes& a, const LaneVec3& b) { return b * a; }
ETENDUE_LANES_INLINE LaneVec3 operator/(const LaneVec3& a, const Lanes& b) {
    return {a.x / b, a.y / b, a.z / b};
}
ETENDUE_LANES_INLINE Lanes dot(const LaneVec3& a, const LaneVec3& b) {
    return a.x * b.x + a.y * b.y + a.z * b.z;
}
ETENDUE_LANES_INLINE LaneVec3 normalize(const LaneVec3& v) { return v * (1 / sqrt(dot(v, v))); }
ETENDUE_LANES_INLINE LaneVec3 select(const LaneMask& mask, const LaneVec3& yes, const LaneVec3& no) {
    return {select(mask, yes.x, no.x), select(mask, yes.y, no.y), select(mask, yes.z, no.z)};
}

ETENDUE_LANES_INLINE LaneVec3 max(const LaneVec3& a, const LaneVec3& b) {
    return {max(a.x, b.x), max(a.y, b.y), max(a.z, b.z)};
}

/// Vectors that come one by one, for lanes; 0 for those that do not. Kept by coordinates, as a vector register would wait
/// for what was written otherwise.
class VectorArrays {
  public:
    void set(int lane, const vec3& v) { x_[lane] = v.x, y_[lane] = v.y, z_[lane] = v.z; }
    LaneVec3 lanes() const { return {lanes_of(x_), lanes_of(y_), lanes_of(z_)}; }

  private:
    PerLane<float> x_{}, y_{}, z_{};
};

/// Numbers that lie together in memory, in the order of members of a structure: a line of the cache.
inline constexpr int LINE_FLOATS = 16;
using LineColumns = std::array<Lanes, LINE_FLOATS>;

/// A line for each lane, turned round: [k] has number k of each. Loaded in whole vectors and transposed by interleaving
/// rows half a matrix apart log2(LANES) times, which takes a fraction of what single numbers do.
ETENDUE_LANES_INLINE LineColumns columns_of(const PerLane<const float*>& lines) {
    using Row = float __attribute__((vector_size(LANES * sizeof(float))));
    const auto interleaved = []<size_t... i>(const Row& a, const Row& b, auto first,
                                             std::index_sequence<i...>) {
        return __builtin_shufflevector(a, b, (i % 2 * size_t{LANES} + i / 2 + first)...);
    };
    LineColumns out;
    for (int column = 0; column < LINE_FLOATS; column += LANES) {
        std::array<Row, LANES> rows, next;
        for (int i = 0; i < LANES; ++i) std::memcpy(&rows[i], lines[i] + column, sizeof(Row));
        for (int stage = 1; stage < LANES; stage *= 2) {
            for (size_t i = 0; i < LANES / 2; ++i) {
                const auto lanes = std::make_index_sequence<LANES>();
                next[2 * i] =
                    interleaved(rows[i], rows[i + LANES / 2], std::integral_constant<size_t, 0>(), lanes);
                next[2 * i + 1] = interleaved(rows[i], rows[i + LANES / 2],
                                              std::integral_constant<size_t, LANES / 2>(), lanes);
            }
            rows = next;
        }
        for (int i = 0; i < LANES; ++i) out[column + i] = std::bit_cast<Lanes>(rows[i]);
    }
    return out;
}
ETENDUE_LANES_INLINE LaneVec3 vector_at(const LineColumns& columns, int first) {
    return {columns[first], columns[first + 1], columns[first + 2]};
}

template <>
struct NumberTypes<Lanes> {
    using Mask = LaneMask;
    using Vec2 = LaneVec2;
    using Vec3 = LaneVec3;
};

}  // namespace etendue
