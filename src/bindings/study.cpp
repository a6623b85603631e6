// What a scene, a sampler, a filter and a camera answer on their own, over whole arrays: for tests, plots and study.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>

#include "bindings/arrays.h"
#include "gi/camera.h"
#include "gi/filter.h"
#include "gi/lane_sampler.h"
#include "gi/scene.h"

namespace etendue {

namespace {

nb::dict intersect(const Scene& scene, const Vectors3& origin, const Vectors3& direction) {
    require_same_length(origin.shape(0), direction.shape(0), "origin and direction");
    const size_t n = origin.shape(0);
    auto position = new_array<OutVectors3>({n, 3}), normal = new_array<OutVectors3>({n, 3}),
         shading = new_array<OutVectors3>({n, 3});
    auto distance = new_array<OutScalars>({n});
    auto uv = new_array<Out<float, nb::shape<-1, 2>>>({n, 2});
    auto material = new_array<Out<int32_t, nb::shape<-1>>>({n});
    for (size_t i = 0; i < n; ++i) {
        const SurfaceHit hit = scene.intersect({vec3_at(origin, i), vec3_at(direction, i)});
        distance.data()[i] = hit.distance;
        material.data()[i] = hit.valid ? static_cast<int32_t>(hit.material - scene.materials().data()) : -1;
        if (!hit.valid) continue;
        set_vec3(position, i, hit.point.position);
        set_vec3(normal, i, hit.point.normal);
        set_vec3(shading, i, hit.frame.n);
        uv.data()[2 * i] = hit.uv().x;
        uv.data()[2 * i + 1] = hit.uv().y;
    }
    nb::dict out;
    out["distance"] = distance, out["position"] = position, out["normal"] = normal,
    out["shading_normal"] = shading;
    out["uv"] = uv, out["material"] = material;
    return out;
}

nb::dict intersect_in_lanes(const Scene& scene, const Vectors3& origin, const Vectors3& direction) {
    require_same_length(origin.shape(0), direction.shape(0), "origin and direction");
    const size_t n = origin.shape(0);
    auto position = new_array<OutVectors3>({n, 3}), normal = new_array<OutVectors3>({n, 3}),
         shading = new_array<OutVectors3>({n, 3});
    in_lanes(n, [&](size_t first, const LaneMask& on) {
        const LaneRays rays{lanes_at(origin, first, on), lanes_at(direction, first, on)};
        const SurfaceHits hits = scene.intersect(rays, on, [] {});
        set_lanes(position, first, hits.valid, hits.point.position);
        set_lanes(normal, first, hits.valid, hits.point.normal);
        set_lanes(shading, first, hits.valid, hits.frame.n);
    });
    nb::dict out;
    out["position"] = position, out["normal"] = normal, out["shading_normal"] = shading;
    return out;
}

nb::ndarray<nb::numpy, float, nb::shape<-1, -1>> points_in_lanes(Sampler sampler, uint32_t pixel,
                                                                 uint64_t first, size_t count,
                                                                 uint32_t vertex, size_t pairs) {
    auto out = new_array<Out<float, nb::shape<-1, -1>>>({count, 2 * pairs});
    in_lanes(count, [&](size_t row, const LaneMask& on) {
        LaneSampler numbers;
        for (int i = 0; i < LANES; ++i) numbers.start(i, sampler.stream(pixel, first + row + i));
        numbers.start_vertex(static_cast<float>(vertex));
        for (size_t pair = 0; pair < pairs; ++pair) {
            const LaneVec2 u = numbers.next_2d(on);
            for_lanes(on, [&](int i) {
                float* const place = out.data() + 2 * ((row + static_cast<size_t>(i)) * pairs + pair);
                place[0] = u.x[i], place[1] = u.y[i];
            });
        }
    });
    return out;
}

void bind_queries(nb::module_& m) {
    // The scene's class is bound with its construction; what it can be asked is added to it here.
    auto scene = nb::borrow<nb::class_<Scene>>(m.attr("Scene"));
    scene.def("intersect", &intersect, nb::arg("origin"), nb::arg("direction"),
              "float32 (n, 3), unit (n, 3). Returns a dict of distance (n,) (inf: miss), position (n, 3), "
              "normal and shading_normal\n"
              "(n, 3) on the ray's side, uv (n, 2) and material (n,) int32 (-1: miss).");
    scene.def("intersect_in_lanes", &intersect_in_lanes, nb::arg("origin"), nb::arg("direction"),
              "position, normal and shading_normal of `intersect`, of many at once, as the path tracers do.");
    scene.def(
        "occluded",
        [](const Scene& self, const Vectors3& from, const Vectors3& to) {
            require_same_length(from.shape(0), to.shape(0), "from and to");
            auto out = new_array<Out<bool, nb::shape<-1>>>({from.shape(0)});
            for (size_t i = 0; i < from.shape(0); ++i) {
                const vec3 origin = vec3_at(from, i);
                out.data()[i] = self.occluded({origin, vec3_at(to, i) - origin, 1});
            }
            return out;
        },
        nb::arg("origin"), nb::arg("target"),
        "float32 (n, 3), (n, 3) -> bool (n,): whether anything is between, ends included.");
}

struct PythonSampler {
    std::string kind;
    uint64_t seed;
};

Sampler::Kind sampler_kind(const std::string& name) {
    return static_cast<Sampler::Kind>(index_of(Sampler::names, name, "sampler"));
}

void bind_sampler(nb::module_& m) {
    nb::class_<PythonSampler>(m, "Sampler",
                              "Random numbers as a function of (seed, pixel, sample index, dimension).")
        .def(
            "__init__",
            [](PythonSampler* self, const std::string& kind, uint64_t seed) {
                sampler_kind(kind);
                new (self) PythonSampler{kind, seed};
            },
            nb::arg("kind") = "sobol", nb::arg("seed") = 0, "Raises ValueError for an unknown kind.")
        .def(
            "points",
            [](const PythonSampler& self, uint32_t pixel, uint64_t first, size_t count, uint32_t vertex,
               size_t pairs, std::optional<std::pair<uint32_t, uint32_t>> part) {
                const Sampler samples(sampler_kind(self.kind), self.seed);
                auto out = new_array<Out<float, nb::shape<-1, -1>>>({count, 2 * pairs});
                for (size_t i = 0; i < count; ++i) {
                    const Sampler::Stream whole = samples.stream(pixel, first + i);
                    Sampler sampler(part ? Sampler::part(whole, part->first, part->second) : whole);
                    sampler.start_vertex(vertex);
                    for (size_t pair = 0; pair < pairs; ++pair) {
                        const vec2 u = sampler.next_2d();
                        out.data()[2 * (i * pairs + pair)] = u.x;
                        out.data()[2 * (i * pairs + pair) + 1] = u.y;
                    }
                }
                return out;
            },
            nb::arg("pixel"), nb::arg("first"), nb::arg("count"), nb::arg("vertex") = 0, nb::arg("pairs") = 1,
            nb::arg("part") = nb::none(),
            "Samples first .. first + count of a pixel: the first `pairs` two-dimensional draws at a vertex "
            "of the path, float32\n"
            "(count, 2 pairs). part: (k, n), the draws of part k of n of each sample, n a power of two.")
        .def(
            "points_in_lanes",
            [](const PythonSampler& self, uint32_t pixel, uint64_t first, size_t count, uint32_t vertex,
               size_t pairs) {
                return points_in_lanes({sampler_kind(self.kind), self.seed}, pixel, first, count, vertex,
                                       pairs);
            },
            nb::arg("pixel"), nb::arg("first"), nb::arg("count"), nb::arg("vertex") = 0, nb::arg("pairs") = 1,
            "As `points`, of many samples at once, as the path tracers do.")
        .def(
            "numbers",
            [](const PythonSampler& self, uint32_t pixel, uint64_t first, size_t count, uint32_t vertex,
               size_t draws) {
                Sampler sampler(sampler_kind(self.kind), self.seed);
                auto out = new_array<Out<float, nb::shape<-1, -1>>>({count, draws});
                for (size_t i = 0; i < count; ++i) {
                    sampler.start(pixel, first + i);
                    sampler.start_vertex(vertex);
                    for (size_t draw = 0; draw < draws; ++draw)
                        out.data()[i * draws + draw] = sampler.next_1d();
                }
                return out;
            },
            nb::arg("pixel"), nb::arg("first"), nb::arg("count"), nb::arg("vertex") = 0, nb::arg("draws") = 1,
            "The same for one-dimensional draws: float32 (count, draws).");
}

void bind_camera(nb::module_& m) {
    nb::class_<Camera>(m, "Camera", "A thin-lens or panorama camera.")
        .def(
            "__init__",
            [](Camera* self, const std::array<float, 3>& pos, const std::array<float, 3>& dir,
               const std::array<float, 3>& up, float fov, float lens_radius, float focal_depth,
               bool perspective, uint32_t width, uint32_t height) {
                if (width < 1 || height < 1 || width > 65535 || height > 65535) {
                    throw std::invalid_argument("an image has 1 to 65535 pixels a side");
                }
                const CameraSettings settings{to_vec3(pos), to_vec3(dir), to_vec3(up), fov,
                                              lens_radius,  focal_depth,  perspective};
                new (self) Camera(settings, width, height);
            },
            nb::arg("pos"), nb::arg("dir"), nb::arg("up"), nb::arg("fov"), nb::arg("lens_radius"),
            nb::arg("focal_depth"), nb::arg("perspective"), nb::arg("width"), nb::arg("height"),
            "dir and up need be neither unit nor orthogonal; fov is vertical, in degrees. Raises ValueError "
            "where dir and up are\n"
            "zero or parallel.")
        .def_prop_ro("width", &Camera::width)
        .def_prop_ro("height", &Camera::height)
        .def_prop_ro("focal_depth", [](const Camera& c) { return c.settings().focal_depth; })
        .def(
            "film_of",
            [](const Camera& c, const std::array<float, 3>& point) -> std::optional<std::array<float, 2>> {
                const auto film = c.film_of(to_vec3(point));
                return film ? std::optional(std::array{film->x, film->y}) : std::nullopt;
            },
            nb::arg("point"),
            "(2,): where the middle of the lens sees a point, in pixels from the top left corner, maybe "
            "outside of "
            "the image;\nNone behind a perspective camera.")
        .def(
            "rays",
            [](const Camera& camera, const Vectors2& film, const Vectors2& lens) {
                require_same_length(film.shape(0), lens.shape(0), "film and lens");
                auto origin = new_array<OutVectors3>({film.shape(0), 3}),
                     direction = new_array<OutVectors3>({film.shape(0), 3});
                for (size_t i = 0; i < film.shape(0); ++i) {
                    const Ray ray = camera.ray(vec2_at(film, i), vec2_at(lens, i));
                    set_vec3(origin, i, ray.origin);
                    set_vec3(direction, i, ray.direction);
                }
                return std::pair{origin, direction};
            },
            nb::arg("film"), nb::arg("lens"),
            "film: float32 (n, 2), pixels from the top left corner. lens: float32 (n, 2) in [0, 1). Returns "
            "origins and unit\n"
            "directions, (n, 3) each.")
        .def(
            "films_of",
            [](const Camera& camera, const Vectors3& points, const Vectors2& lens) {
                require_same_length(points.shape(0), lens.shape(0), "points and lens");
                auto film = new_array<Out<float, nb::shape<-1, 2>>>({points.shape(0), 2});
                auto per_solid_angle = new_array<Out<float, nb::shape<-1>>>({points.shape(0)});
                for (size_t i = 0; i < points.shape(0); ++i) {
                    const auto view = camera.view_of(vec3_at(points, i), vec2_at(lens, i));
                    film.data()[2 * i] = view ? view->film.x : NAN;
                    film.data()[2 * i + 1] = view ? view->film.y : NAN;
                    per_solid_angle.data()[i] = view ? camera.film_per_solid_angle(view->direction) : NAN;
                }
                return std::pair{film, per_solid_angle};
            },
            nb::arg("points"), nb::arg("lens"),
            "The inverse of `rays`. points: float32 (n, 3). lens: float32 (n, 2) in [0, 1). Returns where "
            "rays from "
            "there that meet the\n"
            "points come from the film, (n, 2), in pixels and maybe outside of the image, and how many "
            "pixels of film "
            "see a steradian\n"
            "there, (n,). NaN behind a perspective camera.");
    m.def("auto_focus", &auto_focus, nb::arg("scene"), nb::arg("camera"),
          nb::call_guard<nb::gil_scoped_release>(),
          "Geometric mean of the hit distances of pixel-centre rays over the middle quarter (w/4 x h/4) of "
          "the image; the camera's\n"
          "own focal depth where none hits.");
    m.def(
        "filter_offsets",
        [](const std::string& name, const Vectors2& u) {
            const Filter filter(static_cast<Filter::Kind>(index_of(Filter::names, name, "filter")));
            auto out = new_array<Out<float, nb::shape<-1, 2>>>({u.shape(0), 2});
            for (size_t i = 0; i < u.shape(0); ++i) {
                const vec2 offset = filter.sample(vec2_at(u, i));
                out.data()[2 * i] = offset.x;
                out.data()[2 * i + 1] = offset.y;
            }
            return out;
        },
        nb::arg("filter"), nb::arg("u"),
        "u: float32 (n, 2) in [0, 1) -> offsets from the pixel's centre drawn from the filter, (n, 2).");
    m.def(
        "filter_density",
        [](const std::string& name, const Vectors2& offsets) {
            const Filter filter(static_cast<Filter::Kind>(index_of(Filter::names, name, "filter")));
            auto out = new_array<Out<float, nb::shape<-1>>>({offsets.shape(0)});
            for (size_t i = 0; i < offsets.shape(0); ++i) {
                out.data()[i] = filter.density(vec2_at(offsets, i));
            }
            return out;
        },
        nb::arg("filter"), nb::arg("offsets"),
        "offsets: float32 (n, 2) from the pixel's centre, in pixels -> their density per pixel of area, "
        "(n,).");
}

}  // namespace

void bind_study(nb::module_& m) {
    bind_queries(m);
    bind_sampler(m);
    bind_camera(m);
}

}  // namespace etendue
