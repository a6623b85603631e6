// A film as numpy arrays.
#pragma once

#include "bindings/arrays.h"
#include "gi/film.h"

namespace etendue {

using Sums = In<double, nb::shape<-1, -1, 3>>;
using Counts = In<uint64_t, nb::shape<-1, -1>>;

/// Throws std::invalid_argument for arrays of different sizes.
inline Film film_of(const Sums& sum, const Sums& sum_squares, const Sums& half_sum,
                    const Counts& sample_count, const Counts& invalid_per_pixel, const Counts& half_count) {
    const size_t height = sum.shape(0), width = sum.shape(1);
    const auto require_same_size = [&](const auto& array) {
        require_same_length(array.shape(0), height, "all arrays");
        require_same_length(array.shape(1), width, "all arrays");
    };
    for (const Sums* sums : {&sum_squares, &half_sum}) require_same_size(*sums);
    for (const Counts* counts : {&sample_count, &invalid_per_pixel, &half_count}) require_same_size(*counts);
    Film film(width, height);
    const auto at = [](const Sums& sums, size_t i) {
        return glm::dvec3(sums.data()[3 * i], sums.data()[3 * i + 1], sums.data()[3 * i + 2]);
    };
    for (size_t i = 0; i < width * height; ++i) {
        film.at(i % width, i / width) = {
            at(sum, i),
            at(sum_squares, i),
            at(half_sum, i),
            sample_count.data()[i],
            invalid_per_pixel.data()[i],
            half_count.data()[i],
        };
    }
    return film;
}

}  // namespace etendue
