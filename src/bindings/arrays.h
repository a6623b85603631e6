// Numpy arrays in and out: C-contiguous, of the type that the core uses.
#pragma once

#include <nanobind/nanobind.h>
#include <nanobind/ndarray.h>
#include <nanobind/stl/optional.h>
#include <nanobind/stl/string.h>
#include <nanobind/stl/vector.h>

#include <algorithm>
#include <array>
#include <stdexcept>
#include <string_view>

#include "gi/math.h"

namespace nb = nanobind;

namespace etendue {

template <class T, class Shape>
using In = nb::ndarray<const T, Shape, nb::c_contig, nb::device::cpu>;
using Vectors3 = In<float, nb::shape<-1, 3>>;
using Vectors2 = In<float, nb::shape<-1, 2>>;
using Scalars = In<float, nb::shape<-1>>;

template <class T, class... Nd>
using Out = nb::ndarray<nb::numpy, T, Nd...>;
using OutVectors3 = Out<float, nb::shape<-1, 3>>;
using OutScalars = Out<float, nb::shape<-1>>;

inline vec3 vec3_at(const Vectors3& a, size_t i) {
    return {a.data()[3 * i], a.data()[3 * i + 1], a.data()[3 * i + 2]};
}
inline vec2 vec2_at(const Vectors2& a, size_t i) { return {a.data()[2 * i], a.data()[2 * i + 1]}; }

/// A new array that owns its values, all zero, and the place to write them.
template <class Array>
Array new_array(std::initializer_list<size_t> shape) {
    using T = typename Array::Scalar;
    size_t size = 1;
    for (const size_t n : shape) size *= n;
    T* const data = new T[size]();
    nb::capsule owner(data, [](void* p) noexcept { delete[] static_cast<T*>(p); });
    return Array(data, shape, owner);
}

template <class Array>
void set_vec3(Array& a, size_t i, const vec3& v) {
    for (int c = 0; c < 3; ++c) a.data()[3 * i + c] = v[c];
}

/// Calls work(first, on) for rows in groups of as many as there are lanes; `on`: those that there are.
template <class Work>
void in_lanes(size_t rows, const Work& work) {
    for (size_t first = 0; first < rows; first += LANES) {
        PerLane<bool> on;
        for (size_t i = 0; i < LANES; ++i) on[i] = first + i < rows;
        work(first, mask_of(on));
    }
}

/// Rows from `first` on, in the lanes that are `on`.
inline LaneVec3 lanes_at(const Vectors3& a, size_t first, const LaneMask& on) {
    VectorArrays out;
    for_lanes(on, [&](int i) { out.set(i, vec3_at(a, first + static_cast<size_t>(i))); });
    return out.lanes();
}

template <class Array>
void set_lanes(Array& a, size_t first, const LaneMask& on, const LaneVec3& v) {
    for_lanes(on, [&](int i) { set_vec3(a, first + static_cast<size_t>(i), v.lane(i)); });
}
template <class Array>
void set_lanes(Array& a, size_t first, const LaneMask& on, const Lanes& v) {
    using Value = typename Array::Scalar;
    for_lanes(on, [&](int i) { a.data()[first + static_cast<size_t>(i)] = static_cast<Value>(v[i]); });
}

inline void require_same_length(size_t a, size_t b, const char* what) {
    if (a != b) throw std::invalid_argument(std::string(what) + " must have one row each");
}

/// The place of a name in a list of them. Throws std::invalid_argument where it is not there.
template <size_t N>
size_t index_of(const std::array<std::string_view, N>& names, const std::string& name, const char* what) {
    const auto it = std::ranges::find(names, name);
    if (it == names.end())
        throw std::invalid_argument(std::string("there is no ") + what + " \"" + name + "\"");
    return it - names.begin();
}

inline vec3 to_vec3(const std::array<float, 3>& a) { return {a[0], a[1], a[2]}; }
inline std::array<float, 3> from_vec3(const vec3& v) { return {v.x, v.y, v.z}; }

/// What each file of bindings adds to the module.
void bind_registry(nb::module_& m);
void bind_scene(nb::module_& m);
void bind_bsdf(nb::module_& m);
void bind_lights(nb::module_& m);
void bind_study(nb::module_& m);
void bind_renderer(nb::module_& m);
void bind_paths(nb::module_& m);
void bind_live(nb::module_& m);
void bind_ray_record(nb::module_& m);
void bind_aovs(nb::module_& m);

}  // namespace etendue
