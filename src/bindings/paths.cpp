// What estimators did: a sample's path replayed, and the picture split by technique.
#include <nanobind/stl/array.h>
#include <nanobind/stl/unique_ptr.h>

#include "bindings/arrays.h"
#include "bindings/watch.h"
#include "driver/renderer.h"
#include "driver/replay.h"
#include "driver/techniques.h"

namespace etendue {

namespace {

PathRecord replay_sample(Renderer& renderer, uint32_t x, uint32_t y, uint64_t sample, bool with_lights) {
    const Camera& camera = renderer.sensor().camera;
    if (x >= camera.width() || y >= camera.height()) {
        throw std::invalid_argument("there is no pixel " + std::to_string(x) + "," + std::to_string(y) +
                                    " in an image of " + std::to_string(camera.width()) + "x" +
                                    std::to_string(camera.height()));
    }
    const nb::gil_scoped_release release;
    return replay(renderer.scene(), renderer.sensor(), renderer.algorithm(), x, y, sample, with_lights,
                  renderer.threads());
}

std::string technique_name(const Contribution& found) {
    return std::string(TECHNIQUES[static_cast<size_t>(found.technique)]);
}

void bind_replay(nb::module_& m) {
    nb::class_<Contribution>(m, "Contribution", "Light that a path brought to the camera.")
        .def_prop_ro("technique", &technique_name, "bsdf_sampling or light_sampling.")
        .def_prop_ro(
            "edges", [](const Contribution& c) { return static_cast<int>(c.edges); },
            "Length of the path in rays.")
        .def_prop_ro(
            "unweighted", [](const Contribution& c) { return from_vec3(c.unweighted); },
            "(3,): radiance, as the technique alone would have it.")
        .def_ro("weight", &Contribution::weight, "Of the technique, by multiple importance sampling.")
        .def_ro("borrowed", &Contribution::borrowed, "It was found by another pixel's path, and shared.")
        .def_ro("from_light", &Contribution::from_light, "It was found by a path from a light.")
        .def_ro("by_portal", &Contribution::by_portal,
                "It was found beside the path, through glass or over mirrors.")
        .def_ro("pdf", &Contribution::pdf,
                "Of the last direction by this technique, in solid angle; 0 where it has no density. Of "
                "light that "
                "could be traced\n"
                "from its other end too: per pixel of film and solid angle.")
        .def_ro("other_pdf", &Contribution::other_pdf, "Of the same direction by the other technique.");

    using Shadow = PathVertex::ShadowRay;
    nb::class_<Shadow>(m, "ShadowRay", "A look at a light.")
        .def_prop_ro("origin", [](const Shadow& s) { return from_vec3(s.ray.origin); })
        .def_prop_ro(
            "direction", [](const Shadow& s) { return from_vec3(s.ray.direction); },
            "(3,): to the light; not of unit length.")
        .def_ro("visible", &Shadow::visible);

    nb::class_<PathVertex>(m, "PathVertex", "The end of a path's edge, and what the estimator did there.")
        .def_prop_ro("origin", [](const PathVertex& v) { return from_vec3(v.ray.origin); })
        .def_prop_ro(
            "direction", [](const PathVertex& v) { return from_vec3(v.ray.direction); },
            "(3,): unit, of the ray that led here.")
        .def_prop_ro(
            "hit", [](const PathVertex& v) { return v.hit.valid; }, "False: the ray left the scene.")
        .def_prop_ro("position", [](const PathVertex& v) { return from_vec3(v.hit.point.position); })
        .def_prop_ro(
            "normal", [](const PathVertex& v) { return from_vec3(v.hit.frame.n); },
            "(3,): unit, for shading, on the side that the ray came from.")
        .def_prop_ro("front", [](const PathVertex& v) { return v.hit.front; })
        .def_prop_ro("distance", [](const PathVertex& v) { return v.hit.distance; })
        .def_prop_ro(
            "material",
            [](const PathVertex& v) { return v.hit.material ? v.hit.material->name : std::string(); },
            "Its name; empty where the ray left the scene.")
        .def_prop_ro("bsdf",
                     [](const PathVertex& v) {
                         return v.hit.material ? std::string(bsdfs()[v.hit.material->bsdf].name)
                                               : std::string();
                     })
        .def_prop_ro("albedo", [](const PathVertex& v) { return from_vec3(v.hit.surface().albedo); })
        .def_prop_ro(
            "emitted", [](const PathVertex& v) { return from_vec3(v.hit.Le()); },
            "(3,): radiance that shines from here along the ray.")
        .def_prop_ro(
            "throughput", [](const PathVertex& v) { return from_vec3(v.throughput); },
            "(3,): of the path when it came here.")
        .def_prop_ro(
            "bounce_lobe",
            [](const PathVertex& v) -> std::optional<std::string> {
                if (!v.bounce) return std::nullopt;
                const auto type = static_cast<unsigned>(v.bounce->type);
                std::string name = type & BRDF_SPECULAR ? "specular"
                                   : type & BRDF_GLOSSY ? "glossy"
                                                        : "diffuse";
                return name + (type & BRDF_TRANSMISSION ? " transmission" : " reflection");
            },
            "Of the direction that the path went on in; None: it did not.")
        .def_prop_ro(
            "bounce_pdf",
            [](const PathVertex& v) { return v.bounce ? std::optional(v.bounce->pdf) : std::nullopt; },
            "In solid angle; of a specular lobe the probability of choosing it.")
        .def_prop_ro(
            "bounce_weight",
            [](const PathVertex& v) {
                return v.bounce ? std::optional(from_vec3(v.bounce->weight)) : std::nullopt;
            },
            "(3,): f |cos| / pdf.")
        .def_prop_ro(
            "roulette_q",
            [](const PathVertex& v) { return v.roulette ? std::optional(v.roulette->q) : std::nullopt; },
            "Probability with which Russian roulette ended the path here; None: it was not played.")
        .def_prop_ro("roulette_survived",
                     [](const PathVertex& v) {
                         return v.roulette ? std::optional(v.roulette->survived) : std::nullopt;
                     })
        .def_ro("shadow_rays", &PathVertex::shadow_rays)
        .def_ro("contributions", &PathVertex::contributions);

    nb::class_<PathRecord>(m, "PathRecord", "A sample's path, vertex by vertex.")
        .def_ro("vertices", &PathRecord::vertices)
        .def_ro("from_lights", &PathRecord::from_lights,
                "Contributions that paths from lights brought to this sample.")
        .def_ro("by_portals", &PathRecord::by_portals,
                "Contributions that were found beside the path, from its first surface through glass and "
                "over mirrors.")
        .def_ro("borrowed", &PathRecord::borrowed,
                "Contributions that other pixels' paths found and shared with this one.")
        .def_prop_ro(
            "radiance", [](const PathRecord& p) { return from_vec3(p.radiance); }, "(3,): the estimate.");

    m.def("replay", &replay_sample, nb::arg("renderer"), nb::arg("x"), nb::arg("y"), nb::arg("sample"),
          nb::arg("with_lights") = true,
          "The path of one sample of a pixel, as `renderer` takes it. with_lights: and what paths from "
          "lights bring "
          "to it, for\nwhich those of the whole image are traced; else its radiance is without. Raises "
          "ValueError where there is "
          "no such pixel.");
}

std::unique_ptr<TechniqueFilm> make_technique_film(Renderer& renderer, int max_edges) {
    const nb::gil_scoped_release release;
    return std::make_unique<TechniqueFilm>(renderer.scene(), renderer.sensor(), renderer.algorithm(),
                                           max_edges, renderer.threads());
}

bool render_techniques(TechniqueFilm& film, uint64_t samples, const nb::object& progress) {
    const double all = static_cast<double>(film.width()) * film.height() * static_cast<double>(samples);
    return watched([&] { return film.render(samples); }, [&] { film.cancel(); },
                   [&] {
                       if (!progress.is_none()) progress(static_cast<double>(film.samples_done()) / all);
                   });
}

using TechniqueImages = Out<float, nb::shape<2, 2, -1, -1, -1, 3>>;

template <class Value>
TechniqueImages technique_images(const TechniqueFilm& film, Value&& value) {
    const size_t edges = film.max_edges(), width = film.width(), height = film.height();
    auto out = new_array<TechniqueImages>({2, 2, edges, height, width, 3});
    size_t i = 0;
    for (const auto weighting : {TechniqueFilm::weighted, TechniqueFilm::unweighted}) {
        for (const auto technique : {Technique::bsdf_sampling, Technique::light_sampling}) {
            for (size_t n = 1; n <= edges; ++n) {
                for (uint32_t y = 0; y < height; ++y) {
                    for (uint32_t x = 0; x < width; ++x) {
                        set_vec3(out, i++,
                                 vec3(value(film.at(weighting, technique, static_cast<int>(n), x, y))));
                    }
                }
            }
        }
    }
    return out;
}

TechniqueImages technique_means(const TechniqueFilm& film) {
    const auto n = static_cast<double>(std::max<uint64_t>(film.samples(), 1));
    return technique_images(film, [n](const TechniqueFilm::Sums& s) { return s.sum / n; });
}

TechniqueImages technique_variances(const TechniqueFilm& film) {
    const auto n = static_cast<double>(film.samples());
    return technique_images(film, [n](const TechniqueFilm::Sums& s) {
        if (n < 2) return glm::dvec3(0);
        return glm::max((s.sum_squares - s.sum * s.sum / n) / (n - 1), glm::dvec3(0));
    });
}

void bind_techniques(nb::module_& m) {
    nb::class_<TechniqueFilm>(m, "TechniqueFilm",
                              "The picture split by how its light was found: by technique and path length.")
        .def(nb::new_(&make_technique_film), nb::keep_alive<0, 2>(), nb::arg("renderer"),
             nb::arg("max_edges") = 10,
             "For the scene, camera, estimator and samples of `renderer`, from its seed and sample 0. Paths "
             "of more "
             "than\nmax_edges rays are counted there. Needs 192 bytes x max_edges a pixel.")
        .def("render", &render_techniques, nb::arg("samples"), nb::arg("progress") = nb::none(),
             "Takes so many samples more of every pixel. progress(fraction) is called about 20 times a "
             "second; an "
             "exception in it,\nor from a signal, ends the render and is raised: the film is of no use then.")
        .def("mean", &technique_means,
             "float32 (2, 2, max_edges, height, width, 3): mean radiance, [0] with MIS weights, [1] without; "
             "[:, 0] found by\nBSDF sampling, [:, 1] by light sampling; [:, :, n - 1] over paths of n rays. "
             "The sum "
             "over mean()[0] is the\npicture.")
        .def("variance", &technique_variances,
             "Of the same shape: variance of one sample, estimated without bias; 0 below two samples.")
        .def_prop_ro("samples", &TechniqueFilm::samples, "Taken of every pixel.");
}

}  // namespace

void bind_paths(nb::module_& m) {
    bind_replay(m);
    bind_techniques(m);
}

}  // namespace etendue
