// The renderer, with progress and Ctrl-C.
#include <nanobind/stl/map.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>
#include <nanobind/stl/unique_ptr.h>
#include <nanobind/stl/variant.h>

#include "bindings/film_arrays.h"
#include "bindings/watch.h"
#include "driver/renderer.h"

namespace etendue {

namespace {

std::unique_ptr<Renderer> make_renderer(const Scene& scene, const Camera& camera,
                                        const std::string& algorithm,
                                        const std::map<std::string, ParameterValue>& parameters,
                                        const std::string& sampler, const std::string& filter, uint64_t seed,
                                        int threads, uint64_t first_sample,
                                        const std::shared_ptr<Films>& films, bool prepares) {
    // A film takes its time.
    const nb::gil_scoped_release release;
    Renderer::Settings settings;
    settings.sampler = static_cast<Sampler::Kind>(index_of(Sampler::names, sampler, "sampler"));
    settings.filter = static_cast<Filter::Kind>(index_of(Filter::names, filter, "filter"));
    settings.seed = seed;
    settings.first_sample = first_sample;
    settings.threads = threads;
    settings.films = films;
    settings.prepares = prepares;
    return std::make_unique<Renderer>(scene, camera, make_algorithm(algorithm, parameters), settings);
}

bool render(Renderer& renderer, uint64_t samples, const nb::object& progress,
            std::optional<double> time_limit) {
    const double wanted = static_cast<double>(samples) * static_cast<double>(renderer.film().pixels().size());
    return watched([&] { return renderer.render(samples, time_limit.value_or(INFINITE)); },
                   [&] { renderer.cancel(); },
                   [&] {
                       if (progress.is_none()) return;
                       const double done = static_cast<double>(renderer.samples_done()) / wanted;
                       progress(done, done * static_cast<double>(samples));
                   });
}

bool render_until(Renderer& renderer, double error_bound, const nb::object& progress,
                  std::optional<double> time_limit) {
    const double pixels = static_cast<double>(renderer.film().pixels().size());
    const auto report = [&](bool complete) {
        if (progress.is_none()) return;
        const double done = static_cast<double>(renderer.samples_done());
        const double expected = renderer.samples_expected();
        // What is expected is a guess, and being there is none.
        const double fraction = complete ? 1 : expected > 0 ? std::min(done / expected, 0.999) : 0;
        progress(fraction, done / pixels);
    };
    const bool complete =
        watched([&] { return renderer.render_until(error_bound, time_limit.value_or(INFINITE)); },
                [&] { renderer.cancel(); }, [&] { report(false); });
    if (complete) report(true);
    return complete;
}

/// Calls put(index, pixel) for all pixels, whether or not another thread renders them.
template <class Put>
void read(const Renderer& renderer, const Put& put) {
    const nb::gil_scoped_release release;
    renderer.read([&](const Tile& tile, const Film& film) {
        for (size_t y = tile.y0; y < tile.y1; ++y) {
            for (size_t i = y * film.width() + tile.x0; i < y * film.width() + tile.x1; ++i)
                put(i, film.pixels()[i]);
        }
    });
}

template <class Value>
Out<double, nb::shape<-1, -1, 3>> per_pixel(const Renderer& renderer, const Value& value) {
    const Film& film = renderer.film();
    auto out = new_array<Out<double, nb::shape<-1, -1, 3>>>({film.height(), film.width(), 3});
    read(renderer, [&](size_t i, const Pixel& pixel) {
        const glm::dvec3 v = value(pixel);
        for (int c = 0; c < 3; ++c) out.data()[3 * i + c] = v[c];
    });
    return out;
}

Out<float, nb::shape<-1, -1, 3>> mean(const Renderer& renderer) {
    const Film& film = renderer.film();
    auto out = new_array<Out<float, nb::shape<-1, -1, 3>>>({film.height(), film.width(), 3});
    read(renderer, [&](size_t i, const Pixel& pixel) { set_vec3(out, i, pixel.mean()); });
    return out;
}

template <class Value>
Out<uint64_t, nb::shape<-1, -1>> counts(const Renderer& renderer, const Value& value) {
    const Film& film = renderer.film();
    auto out = new_array<Out<uint64_t, nb::shape<-1, -1>>>({film.height(), film.width()});
    read(renderer, [&](size_t i, const Pixel& pixel) { out.data()[i] = value(pixel); });
    return out;
}

void resume(Renderer& renderer, const Sums& sum, const Sums& sum_squares, const Sums& half_sum,
            const Counts& sample_count, const Counts& invalid_per_pixel, const Counts& half_count) {
    renderer.resume(film_of(sum, sum_squares, half_sum, sample_count, invalid_per_pixel, half_count));
}

nb::tuple film_error_of(const Sums& sum, const Sums& sum_squares, const Sums& half_sum,
                        const Counts& sample_count, const Counts& invalid_per_pixel, const Counts& half_count,
                        uint32_t sharing) {
    const Film film = film_of(sum, sum_squares, half_sum, sample_count, invalid_per_pixel, half_count);
    TileWorkers workers(thread_count(0));
    const std::vector<TileError> tiles = tile_errors(film, workers, sharing);
    const FilmError whole = film_error(tiles);
    const size_t columns = (film.width() + Tiles::SIDE - 1) / Tiles::SIDE;
    auto errors = new_array<Out<double, nb::shape<-1, -1>>>({tiles.size() / columns, columns});
    std::ranges::transform(tiles, errors.data(), &TileError::error);
    return nb::make_tuple(whole.error, whole.low, whole.high, errors);
}

// Doubles in the order of memory: technique, part, colour.
constexpr size_t SPLIT = sizeof(ContributionSums) / sizeof(double);
static_assert(SPLIT == TECHNIQUES.size() * ContributionSums::PARTS * 3);
using Split = nb::shape<-1, -1, TECHNIQUES.size(), ContributionSums::PARTS, 3>;

void split(Renderer& renderer, std::optional<In<double, Split>> sums) {
    std::vector<ContributionSums> pixels(renderer.film().pixels().size());
    if (sums) {
        require_same_length(sums->size(), pixels.size() * SPLIT, "the film and the contributions");
        std::copy_n(sums->data(), sums->size(), reinterpret_cast<double*>(pixels.data()));
    }
    renderer.split(std::move(pixels));
}

std::optional<Out<double, Split>> contributions(const Renderer& renderer) {
    if (renderer.contributions().empty()) return std::nullopt;
    const Film& film = renderer.film();
    auto out = new_array<Out<double, Split>>(
        {film.height(), film.width(), TECHNIQUES.size(), ContributionSums::PARTS, 3});
    std::copy_n(reinterpret_cast<const double*>(renderer.contributions().data()), out.size(), out.data());
    return out;
}

}  // namespace

void bind_renderer(nb::module_& m) {
    nb::class_<Films>(m, "Films",
                      "Memory for renderers that follow each other: what one had, the next clears and takes.")
        .def(nb::init<>())
        .def("settle", &Films::settle, nb::arg("width"), nb::arg("height"),
             nb::call_guard<nb::gil_scoped_release>(), "Has the memory of one film ready, and no more.");
    nb::class_<Renderer>(m, "Renderer",
                         "Renders a scene into its film, as far as it is asked to, again and again.")
        .def(
            nb::new_(&make_renderer), nb::keep_alive<0, 2>(), nb::arg("scene"), nb::arg("camera"),
            nb::arg("algorithm"), nb::arg("parameters") = std::map<std::string, ParameterValue>{},
            nb::arg("sampler") = "sobol", nb::arg("filter") = "blackman_harris", nb::arg("seed") = 0,
            nb::arg("threads") = 0, nb::arg("first_sample") = 0, nb::arg("films").none() = nb::none(),
            nb::arg("prepares") = true,
            "parameters: values of the algorithm's parameters by name. threads: 0 for all cores. "
            "first_sample: the\n"
            "index of each pixel's first sample. films: whose memory its film takes, and gives back with the "
            "last reference to the\n"
            "renderer. prepares: whether the estimator may learn something before the first sample (see "
            "`prepare`). Raises\nValueError for names and values that do not fit.")
        .def("render", &render, nb::arg("samples"), nb::arg("progress") = nb::none(),
             nb::arg("time_limit") = nb::none(),
             "Brings every pixel to `samples` samples, going on from those it has, with the interpreter free "
             "for other threads.\n"
             "progress(fraction, samples_per_pixel) is called about 20 times a second; an exception in it, "
             "or from a signal, cancels\n"
             "the render within 100 ms and is raised. time_limit: seconds, after the first sample of each "
             "pixel.\n"
             "Returns whether all samples were taken.")
        .def("render_until", &render_until, nb::arg("error_bound"), nb::arg("progress") = nb::none(),
             nb::arg("time_limit") = nb::none(),
             "A beauty render: gives every pixel 16 samples, then more to the worst tiles, until `error` is "
             "within the bound.\n"
             "The other arguments are those of `render`, but that the fraction of progress is a guess. "
             "Returns whether the bound\n"
             "is kept. How many samples a pixel has in the end depends on the samples alone.")
        .def("prepare", nb::overload_cast<>(&Renderer::prepare), nb::call_guard<nb::gil_scoped_release>(),
             "Lets the estimator learn what it wants to know before its first sample, as a render would: a "
             "fraction of a second.\nReturns False where `cancel` ended it.")
        .def_prop_ro("learns", &Renderer::learns,
                     "Whether the estimator has anything to learn in this scene, where it may.")
        .def("cancel", &Renderer::cancel, "Makes a running render return, from another thread.")
        .def("mean", &mean,
             "float32 (height, width, 3): linear radiance, row 0 at the top; 0 where there is no sample.")
        .def(
            "sum", [](const Renderer& r) { return per_pixel(r, [](const Pixel& p) { return p.sum; }); },
            "float64 (height, width, 3): sum of the valid samples.")
        .def(
            "sum_squares",
            [](const Renderer& r) { return per_pixel(r, [](const Pixel& p) { return p.sum_squares; }); },
            "float64 (height, width, 3): sum of their squares.")
        .def(
            "half_sum",
            [](const Renderer& r) { return per_pixel(r, [](const Pixel& p) { return p.half_sum; }); },
            "float64 (height, width, 3): sum of the valid samples of one half, of those whose index is in "
            "the first half of an\n"
            "octave [2^k, 2^(k + 1)), or of the first 16.")
        .def(
            "sample_count",
            [](const Renderer& r) { return counts(r, [](const Pixel& p) { return p.count; }); },
            "uint64 (height, width): samples taken.")
        .def(
            "invalid_per_pixel",
            [](const Renderer& r) { return counts(r, [](const Pixel& p) { return p.invalid; }); },
            "uint64 (height, width): of those, how many are not in the sums.")
        .def(
            "half_count",
            [](const Renderer& r) { return counts(r, [](const Pixel& p) { return p.half_count; }); },
            "uint64 (height, width): samples in half_sum.")
        .def("resume", &resume, nb::arg("sum"), nb::arg("sum_squares"), nb::arg("half_sum"),
             nb::arg("sample_count"), nb::arg("invalid_per_pixel"), nb::arg("half_count"),
             "Goes on from these, as another renderer of the same scene, settings and first sample gave "
             "them. Raises\n"
             "ValueError for another size.")
        .def("split", &split, nb::arg("sums") = nb::none(),
             "From now on keeps contributions apart. sums: as another renderer gave them, to go on from, or "
             "None "
             "for zeros.\n"
             "Raises ValueError for another size.")
        .def(
            "contributions", &contributions,
            "float64 (height, width, 2, 2, 3), or None without `split`: sums of what BSDF sampling and light "
            "sampling found,\n"
            "of each over at most two edges and over more, weighted by MIS. Together they are `sum`.")
        .def_prop_ro("rays", &Renderer::rays,
                     "Rays traced, shadow rays included, without those of `prepare`.")
        .def_prop_ro("seconds", &Renderer::seconds, "Time spent in `render`.")
        .def_prop_ro("threads", &Renderer::threads)
        .def_prop_ro(
            "sharing", [](Renderer& r) { return r.algorithm().sharing(); },
            "How many pixels share what their paths find, see the function `sharing`.")
        .def_prop_ro(
            "light_samples", [](Renderer& r) { return r.algorithm().light_samples(); },
            "How many lights are sampled at the first surface of each path, by estimators that sample "
            "lights.")
        .def_prop_ro(
            "by_portals", [](Renderer& r) { return r.algorithm().by_portals(); },
            "Whether directions to smooth glass and mirrors are sampled there too.")
        .def_prop_ro(
            "light_paths", [](Renderer& r) { return r.algorithm().light_paths(); },
            "How many paths from lights belong to a sample of every pixel; 0: none.")
        .def_prop_ro("error", &Renderer::error,
                     "Error of the film as the running or last render last saw it (see film_error); infinite "
                     "where it cannot\n"
                     "be told.")
        .def_prop_ro("invalid_count", &Renderer::invalid_count,
                     "Samples that were no finite numbers >= 0; not in the sums.")
        .def_prop_ro(
            "invalid",
            [](const Renderer& r) {
                std::vector<std::tuple<uint32_t, uint32_t, uint64_t>> all;
                for (const auto& s : r.invalid_samples()) all.emplace_back(s.x, s.y, s.sample);
                return all;
            },
            "The first thousand of them: (x, y, sample).");
    m.def(
        "film_error", &film_error_of, nb::arg("sum"), nb::arg("sum_squares"), nb::arg("half_sum"),
        nb::arg("sample_count"), nb::arg("invalid_per_pixel"), nb::arg("half_count"), nb::arg("sharing") = 1,
        nb::sig("def film_error(sum: NDArray[numpy.float64], sum_squares: NDArray[numpy.float64], half_sum: "
                "NDArray[numpy.float64], sample_count: NDArray[numpy.uint64], invalid_per_pixel: "
                "NDArray[numpy.uint64], half_count: NDArray[numpy.uint64], sharing: int = 1) -> tuple[float, "
                "float, "
                "float, "
                "NDArray[numpy.float64]]"),
        "The error of a film, the lower and the upper end of its 95% confidence interval, and the errors of "
        "its tiles of\n"
        "16 x 16 pixels, (rows, columns). A tile's is relative: the root mean square of its pixels' and "
        "channels' standard\n"
        "errors, estimated from the halves, over its mean radiance; the film's is what 95% of the tiles do "
        "not exceed.\nsharing: how many pixels shared their paths, see `sharing`.");
    m.def(
        "sharing",
        [](const std::string& algorithm, const std::map<std::string, ParameterValue>& parameters) {
            return make_algorithm(algorithm, parameters)->sharing_at_most();
        },
        nb::arg("algorithm"), nb::arg("parameters"),
        "How many pixels at most, all in one tile of 16 x 16, an estimator lets share what their paths find: "
        "their "
        "estimates are not\nindependent of each other. 1: none. Raises ValueError for names and values that "
        "do not fit.");
}

}  // namespace etendue
