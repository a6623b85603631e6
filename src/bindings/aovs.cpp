// What is seen in the pixels beside their radiance, as arrays.
#include "driver/aovs.h"

#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/unique_ptr.h>

#include "bindings/arrays.h"
#include "bindings/watch.h"

namespace etendue {

namespace {

bool render(AovPass& pass, uint64_t first, uint64_t samples, const nb::object& progress) {
    return watched([&] { return pass.render(first, samples); }, [&] { pass.cancel(); },
                   [&] {
                       if (!progress.is_none()) progress(pass.done());
                   });
}

/// Sums over counts; `empty` where there is none.
Out<float, nb::shape<-1, -1, 3>> means(const AovPass& pass, glm::dvec3 AovPixel::* sum,
                                       uint64_t AovPixel::* count) {
    auto out = new_array<Out<float, nb::shape<-1, -1, 3>>>({pass.height(), pass.width(), 3});
    for (size_t i = 0; i < pass.pixels().size(); ++i) {
        const AovPixel& pixel = pass.pixels()[i];
        if (pixel.*count > 0) set_vec3(out, i, pixel.*sum / static_cast<double>(pixel.*count));
    }
    return out;
}

Out<float, nb::shape<-1, -1>> mean_depth(const AovPass& pass) {
    auto out = new_array<Out<float, nb::shape<-1, -1>>>({pass.height(), pass.width()});
    for (size_t i = 0; i < pass.pixels().size(); ++i) {
        const AovPixel& pixel = pass.pixels()[i];
        out.data()[i] =
            pixel.hits > 0 ? static_cast<float>(pixel.depth / static_cast<double>(pixel.hits)) : INFINITE;
    }
    return out;
}

Out<int32_t, nb::shape<-1, -1>> ids(const AovPass& pass, Majority AovPixel::* id) {
    auto out = new_array<Out<int32_t, nb::shape<-1, -1>>>({pass.height(), pass.width()});
    for (size_t i = 0; i < pass.pixels().size(); ++i) out.data()[i] = (pass.pixels()[i].*id).value;
    return out;
}

}  // namespace

void bind_aovs(nb::module_& m) {
    nb::class_<AovPass>(m, "AovPass", "What the camera rays of a picture's samples hit first, averaged.")
        .def(nb::new_([](const Scene& scene, const Camera& camera, const std::string& sampler,
                         const std::string& filter, uint64_t seed, int threads) {
                 const auto filter_kind =
                     static_cast<Filter::Kind>(index_of(Filter::names, filter, "filter"));
                 const auto sampler_kind =
                     static_cast<Sampler::Kind>(index_of(Sampler::names, sampler, "sampler"));
                 return std::make_unique<AovPass>(
                     scene, Sensor{camera, Filter(filter_kind), sampler_kind, seed}, threads);
             }),
             nb::keep_alive<0, 2>(), nb::arg("scene"), nb::arg("camera"), nb::arg("sampler") = "sobol",
             nb::arg("filter") = "blackman_harris", nb::arg("seed") = 0, nb::arg("threads") = 0,
             "As of the Renderer whose samples are meant.")
        .def(
            "render", &render, nb::arg("first"), nb::arg("samples"), nb::arg("progress") = nb::none(),
            "Adds the samples of the indices [first, first + samples). progress(fraction) is called about 20 "
            "times a second;\n"
            "an exception in it, or from a signal, ends the pass within 100 ms and is raised.")
        .def(
            "albedo", [](const AovPass& p) { return means(p, &AovPixel::albedo, &AovPixel::count); },
            "float32 (height, width, 3), 0..1: of what is seen first; 0 where nothing is.")
        .def(
            "normal", [](const AovPass& p) { return means(p, &AovPixel::normal, &AovPixel::count); },
            "float32 (height, width, 3): mean shading normal in the world, on the viewer's side.")
        .def(
            "position", [](const AovPass& p) { return means(p, &AovPixel::position, &AovPixel::hits); },
            "float32 (height, width, 3): mean over the rays that hit; 0 where none does.")
        .def("depth", &mean_depth,
             "float32 (height, width): mean distance along the view over the rays that hit; infinite where "
             "none "
             "does.")
        .def(
            "object_id", [](const AovPass& p) { return ids(p, &AovPixel::object); },
            "int32 (height, width): index of the mesh that most rays hit; -1: none.")
        .def(
            "material_id", [](const AovPass& p) { return ids(p, &AovPixel::material); },
            "int32 (height, width): index of the material that most rays hit; -1: none.")
        .def(
            "denoising_albedo",
            [](const AovPass& p) { return means(p, &AovPixel::denoising_albedo, &AovPixel::count); },
            "float32 (height, width, 3), 0..1: behind mirrors and glass, with what shines.")
        .def(
            "denoising_normal",
            [](const AovPass& p) { return means(p, &AovPixel::denoising_normal, &AovPixel::count); },
            "float32 (height, width, 3): behind mirrors and glass.");
}

}  // namespace etendue
