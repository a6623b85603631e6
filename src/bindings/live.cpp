// What a viewer sees of a renderer while it renders.
#include <nanobind/stl/array.h>
#include <nanobind/stl/tuple.h>

#include "bindings/arrays.h"
#include "driver/renderer.h"

namespace etendue {

namespace {

using Picture = Out<float, nb::shape<-1, -1, 3>>;
using Sums = Out<double, nb::shape<-1, -1, 3>>;
using Counts = Out<uint64_t, nb::shape<-1, -1>>;

/// The pixel, or the one that stands for it while coarser ones alone have samples.
const Pixel& seen(const Film& film, uint32_t x, uint32_t y) {
    const auto at = [&](uint32_t mask) -> const Pixel& {
        return film.pixels()[size_t{y & ~mask} * film.width() + (x & ~mask)];
    };
    // As far as a tile reaches, whose lock is held.
    for (uint32_t side = 1; side < Tiles::SIDE; side *= 2) {
        if (at(side - 1).count > 0) return at(side - 1);
    }
    return at(Tiles::SIDE - 1);
}

bool render_coarse(Renderer& renderer, uint32_t stride) {
    if (stride < 1 || Tiles::SIDE % stride != 0)
        throw std::invalid_argument("stride: 1, 2, 4, 8 or 16 is needed");
    const nb::gil_scoped_release release;
    return renderer.render_coarse(stride);
}

Picture picture(const Renderer& renderer, uint32_t stride) {
    if (stride < 1 || Tiles::SIDE % stride != 0)
        throw std::invalid_argument("stride: 1, 2, 4, 8 or 16 is needed");
    const uint32_t width = (renderer.film().width() + stride - 1) / stride;
    const uint32_t height = (renderer.film().height() + stride - 1) / stride;
    auto out = new_array<Picture>({height, width, 3});
    const nb::gil_scoped_release release;
    renderer.read([&](const Tile& tile, const Film& film) {
        for (uint32_t y = tile.y0; y < tile.y1; y += stride) {
            for (uint32_t x = tile.x0; x < tile.x1; x += stride) {
                set_vec3(out, size_t{y / stride} * width + x / stride, seen(film, x, y).mean());
            }
        }
    });
    return out;
}

std::tuple<Sums, Sums, Sums, Counts, Counts, Counts> snapshot(const Renderer& renderer) {
    const size_t height = renderer.film().height(), width = renderer.film().width();
    auto sum = new_array<Sums>({height, width, 3}), sum_squares = new_array<Sums>({height, width, 3}),
         half_sum = new_array<Sums>({height, width, 3});
    auto count = new_array<Counts>({height, width}), invalid = new_array<Counts>({height, width}),
         half_count = new_array<Counts>({height, width});
    {
        const nb::gil_scoped_release release;
        renderer.read([&](const Tile& tile, const Film& film) {
            for (uint32_t y = tile.y0; y < tile.y1; ++y) {
                for (uint32_t x = tile.x0; x < tile.x1; ++x) {
                    const size_t i = y * width + x;
                    const Pixel& pixel = film.pixels()[i];
                    for (int c = 0; c < 3; ++c) {
                        sum.data()[3 * i + c] = pixel.sum[c];
                        sum_squares.data()[3 * i + c] = pixel.sum_squares[c];
                        half_sum.data()[3 * i + c] = pixel.half_sum[c];
                    }
                    count.data()[i] = pixel.count;
                    invalid.data()[i] = pixel.invalid;
                    half_count.data()[i] = pixel.half_count;
                }
            }
        });
    }
    return {sum, sum_squares, half_sum, count, invalid, half_count};
}

using Vector = std::array<double, 3>;

/// Mean, variance of one sample, samples, and how many of them are invalid.
std::optional<std::tuple<Vector, Vector, uint64_t, uint64_t>> pixel(const Renderer& renderer, uint32_t x,
                                                                    uint32_t y) {
    if (x >= renderer.film().width() || y >= renderer.film().height()) return std::nullopt;
    const Pixel pixel = renderer.read(x, y);
    const double n = static_cast<double>(pixel.count - pixel.invalid);
    Vector mean{}, variance{};
    for (int c = 0; c < 3; ++c) {
        if (n > 0) mean[c] = pixel.sum[c] / n;
        if (n > 1) variance[c] = std::max(pixel.sum_squares[c] - pixel.sum[c] * mean[c], 0.0) / (n - 1);
    }
    return std::tuple{mean, variance, pixel.count, pixel.invalid};
}

}  // namespace

void bind_live(nb::module_& m) {
    nb::borrow<nb::class_<Renderer>>(m.attr("Renderer"))
        .def("render_coarse", &render_coarse, nb::arg("stride"),
             "Gives the pixels whose x and y are multiples of stride (1, 2, 4, 8 or 16) their first sample, "
             "which `render` then\n"
             "need not take. Returns False where `cancel` ended it. Raises ValueError for another stride.")
        .def("picture", &picture, nb::arg("stride") = 1,
             "float32 (ceil(height / stride), ceil(width / stride), 3): mean radiance of every stride-th "
             "pixel. "
             "A pixel without\n"
             "samples is as the nearest to its left and above that `render_coarse` gave one. May be called "
             "while another thread\n"
             "renders. Raises ValueError for a stride that is not 1, 2, 4, 8 or 16.")
        .def("pixel", &pixel, nb::arg("x"), nb::arg("y"),
             "(mean, variance of one sample, samples, invalid samples) of a pixel, also while another thread "
             "renders; mean and\n"
             "variance have three channels. None outside of the image.")
        .def_prop_ro("samples_done", &Renderer::samples_done,
                     "Pixels x samples, of those that the running or last `render` was asked for, that are "
                     "there.")
        .def("snapshot", &snapshot,
             "What `sum`, `sum_squares`, `half_sum`, `sample_count`, `invalid_per_pixel` and `half_count` "
             "give, "
             "of the same moment\n"
             "in each pixel, also while another thread renders.");
}

}  // namespace etendue
