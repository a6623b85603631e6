// The parts of light transport on their own, over whole arrays: for tests, plots and study.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>

#include "algorithms/direct_light.h"
#include "bindings/arrays.h"
#include "gi/camera.h"
#include "gi/filter.h"
#include "gi/sampler.h"
#include "gi/scene.h"

namespace etendue {

namespace {

/// A BSDF with its parameters, in the local frame.
struct PythonBsdf {
    BsdfKind kind;
    Surface surface;
};

OutVectors3 evaluate_f(const PythonBsdf& bsdf, const Vectors3& wo, const Vectors3& wi) {
    require_same_length(wo.shape(0), wi.shape(0), "wo and wi");
    auto out = new_array<OutVectors3>({wo.shape(0), 3});
    for (size_t i = 0; i < wo.shape(0); ++i)
        set_vec3(out, i, bsdf_f(bsdf.kind, bsdf.surface, vec3_at(wo, i), vec3_at(wi, i)));
    return out;
}

OutScalars evaluate_pdf(const PythonBsdf& bsdf, const Vectors3& wo, const Vectors3& wi) {
    require_same_length(wo.shape(0), wi.shape(0), "wo and wi");
    auto out = new_array<OutScalars>({wo.shape(0)});
    for (size_t i = 0; i < wo.shape(0); ++i) {
        out.data()[i] = bsdf_pdf(bsdf.kind, bsdf.surface, vec3_at(wo, i), vec3_at(wi, i));
    }
    return out;
}

nb::dict draw_bsdf(const PythonBsdf& bsdf, const Vectors3& wo, const Vectors3& u) {
    require_same_length(wo.shape(0), u.shape(0), "wo and u");
    const size_t n = wo.shape(0);
    auto wi = new_array<OutVectors3>({n, 3}), weight = new_array<OutVectors3>({n, 3});
    auto pdf = new_array<OutScalars>({n}), eta2 = new_array<OutScalars>({n});
    auto type = new_array<Out<uint8_t, nb::shape<-1>>>({n});
    for (size_t i = 0; i < n; ++i) {
        const vec3 random = vec3_at(u, i);
        const auto sample =
            bsdf_sample(bsdf.kind, bsdf.surface, vec3_at(wo, i), random.x, {random.y, random.z});
        if (!sample) continue;
        set_vec3(wi, i, sample->wi);
        set_vec3(weight, i, sample->weight);
        pdf.data()[i] = sample->pdf;
        eta2.data()[i] = sample->eta2;
        type.data()[i] = sample->type;
    }
    nb::dict out;
    out["wi"] = wi, out["weight"] = weight, out["pdf"] = pdf, out["eta2"] = eta2, out["type"] = type;
    return out;
}

void bind_bsdf(nb::module_& m) {
    nb::class_<PythonBsdf>(
        m, "Bsdf",
        "A BSDF in its local frame: z is the shading normal, wo.z > 0, both directions unit and away from "
        "the\n"
        "surface, wi.z < 0 for transmission. f excludes the cosine; pdfs are in solid angle.")
        .def(
            "__init__",
            [](PythonBsdf* self, const std::string& type, const std::array<float, 3>& albedo, float ior,
               float roughness, float absorb, bool coated, bool front) {
                new (self)
                    PythonBsdf{bsdf_of(type), {to_vec3(albedo), ior, roughness, absorb, coated, front}};
            },
            nb::arg("type"), nb::arg("albedo") = std::array{0.8f, 0.8f, 0.8f}, nb::arg("ior") = 1.5f,
            nb::arg("roughness") = 0.1f, nb::arg("absorb") = 0.f, nb::arg("coated") = false,
            nb::arg("front") = true,
            "type: a BSDF or material type. front: whether wo is on the outside. Raises ValueError for an "
            "unknown type.")
        .def_prop_ro("name", [](const PythonBsdf& b) { return std::string(bsdfs()[b.kind].name); })
        .def_prop_ro(
            "is_delta", [](const PythonBsdf& b) { return bsdfs()[b.kind].is_delta; },
            "Whether f and pdf are 0 everywhere.")
        .def_prop_ro(
            "is_reciprocal", [](const PythonBsdf& b) { return bsdfs()[b.kind].is_reciprocal; },
            "Whether f(wo, wi) == f(wi, wo) is claimed.")
        .def("f", &evaluate_f, nb::arg("wo"), nb::arg("wi"),
             "float32 (n, 3), (n, 3) -> (n, 3): the BSDF, cosine excluded.")
        .def("pdf", &evaluate_pdf, nb::arg("wo"), nb::arg("wi"),
             "float32 (n, 3), (n, 3) -> (n,): density of `sample` at wi.")
        .def("sample", &draw_bsdf, nb::arg("wo"), nb::arg("u"),
             "wo: float32 (n, 3). u: float32 (n, 3) in [0, 1): lobe choice and two for the direction.\n"
             "Returns a dict of wi (n, 3), weight (n, 3) = f |cos| / pdf, pdf (n,), eta2 (n,) and type (n,) "
             "uint8 of BRDF_ bits;\n"
             "type is 0 where sampling failed.");
    m.def(
        "bsdfs",
        [] {
            std::vector<std::string> names;
            for (const BsdfInfo& info : bsdfs()) names.emplace_back(info.name);
            return names;
        },
        "Names of all BSDFs.");
    m.attr("BRDF_DIFFUSE") = static_cast<int>(BRDF_DIFFUSE);
    m.attr("BRDF_GLOSSY") = static_cast<int>(BRDF_GLOSSY);
    m.attr("BRDF_SPECULAR") = static_cast<int>(BRDF_SPECULAR);
    m.attr("BRDF_TRANSMISSION") = static_cast<int>(BRDF_TRANSMISSION);
}

/// A light of a scene, which it keeps alive.
struct PythonLight {
    std::shared_ptr<Scene> scene;
    size_t index;

    /// Its triangles by their power; of a sky, itself.
    Distribution1D triangles() const {
        const Light& light = **this;
        if (!light.mesh()) return Distribution1D(std::array{1.});
        std::vector<double> powers(light.mesh()->triangles.size());
        for (uint32_t i = 0; i < powers.size(); ++i) powers[i] = light.bounds(i).power;
        return Distribution1D(powers);
    }

    const Light& operator*() const { return scene->lights()[index]; }
    const Light* operator->() const { return &scene->lights()[index]; }
};

nb::dict draw_light(const PythonLight& light, const Vectors3& reference, const Vectors2& u, bool with_mis) {
    require_same_length(reference.shape(0), u.shape(0), "reference and u");
    const size_t n = reference.shape(0);
    auto wi = new_array<OutVectors3>({n, 3}), radiance = new_array<OutVectors3>({n, 3}),
         position = new_array<OutVectors3>({n, 3});
    auto pdf = new_array<OutScalars>({n});
    auto chosen = new_array<Out<int32_t, nb::shape<-1>>>({n});
    const Distribution1D triangles = light.triangles();
    for (size_t i = 0; i < n && triangles.total() > 0; ++i) {
        vec2 numbers = vec2_at(u, i);
        const auto triangle = triangles.sample(numbers.x);
        numbers.x = triangle.remapped;
        chosen.data()[i] = static_cast<int32_t>(triangle.index);
        const auto sample = light->sample_Li(vec3_at(reference, i), triangle.index, numbers, with_mis);
        if (!sample) continue;
        set_vec3(wi, i, sample->wi);
        set_vec3(radiance, i, sample->radiance);
        set_vec3(position, i, sample->point.position);
        pdf.data()[i] = triangle.pmf * sample->pdf;
    }
    nb::dict out;
    out["wi"] = wi, out["radiance"] = radiance, out["pdf"] = pdf, out["position"] = position;
    out["triangle"] = chosen;
    return out;
}

/// Calls `with(i, hit)` for the first thing that each ray finds, if it is this light.
template <class With>
void for_each_find(const PythonLight& light, const Vectors3& reference, const Vectors3& wi, With&& with) {
    require_same_length(reference.shape(0), wi.shape(0), "reference and wi");
    for (size_t i = 0; i < reference.shape(0); ++i) {
        const SurfaceHit hit = light.scene->intersect({vec3_at(reference, i), vec3_at(wi, i)});
        if (hit.light == &*light) with(i, hit);
    }
}

void bind_light(nb::module_& m) {
    nb::class_<PythonLight>(m, "Light",
                            "A light of a scene. World frame; pdfs in solid angle at the reference point.")
        .def_prop_ro(
            "kind", [](const PythonLight& l) { return std::string(l->name()); },
            "\"AreaLight\" or \"SkyLight\", ...")
        .def_prop_ro(
            "power", [](const PythonLight& l) { return l->power(); }, "What lights are chosen by.")
        .def_prop_ro(
            "material",
            [](const PythonLight& l) -> std::optional<std::string> {
                if (!l->mesh()) return std::nullopt;
                return l.scene->materials()[l->mesh()->material].name;
            },
            "Name of the material of its mesh; None for the sky.")
        .def_prop_ro(
            "triangle_count",
            [](const PythonLight& l) { return l->mesh() ? l->mesh()->triangles.size() : 1; },
            "Of its mesh; 1 for the sky.")
        .def("sample_Li", &draw_light, nb::arg("reference"), nb::arg("u"), nb::arg("with_mis") = false,
             "reference: float32 (n, 3). u: float32 (n, 2) in [0, 1). Chooses a triangle by its power. "
             "Returns a dict "
             "of wi (n, 3), radiance "
             "(n, 3), pdf (n,), triangle (n,) int32 and\n"
             "position (n, 3) on the light; pdf is 0 where the point drawn cannot shine there. Occlusion is "
             "not looked at.")
        .def(
            "pdf_Li",
            [](const PythonLight& light, const Vectors3& reference, const Vectors3& wi, bool with_mis) {
                auto out = new_array<OutScalars>({wi.shape(0)});
                const Distribution1D triangles = light.triangles();
                for_each_find(light, reference, wi, [&](size_t i, const SurfaceHit& hit) {
                    if (triangles.total() > 0)
                        out.data()[i] = triangles.pmf(hit.triangle) * light->pdf_Li(hit, with_mis);
                });
                return out;
            },
            nb::arg("reference"), nb::arg("wi"), nb::arg("with_mis") = false,
            "float32 (n, 3), (n, 3) -> (n,): density of `sample_Li` at wi, 0 where the ray finds something "
            "else first.")
        .def(
            "Le",
            [](const PythonLight& light, const Vectors3& reference, const Vectors3& wi) {
                auto out = new_array<OutVectors3>({wi.shape(0), 3});
                for_each_find(light, reference, wi,
                              [&](size_t i, const SurfaceHit& hit) { set_vec3(out, i, hit.Le()); });
                return out;
            },
            nb::arg("reference"), nb::arg("wi"),
            "float32 (n, 3), (n, 3) -> (n, 3): radiance of this light seen from there, 0 where something "
            "else is in front.");
}

LightSampler::Kind light_choice_named(const std::string& name) {
    return static_cast<LightSampler::Kind>(index_of(LightSampler::names, name, "light_choice"));
}

nb::dict sample_light(const Scene& scene, const Vectors3& reference, const Vectors2& u,
                      const std::string& light_choice, bool with_mis) {
    require_same_length(reference.shape(0), u.shape(0), "reference and u");
    const size_t n = reference.shape(0);
    const LightSampler::Kind kind = light_choice_named(light_choice);
    auto index = new_array<Out<int32_t, nb::shape<-1>>>({n});
    auto wi = new_array<OutVectors3>({n, 3}), radiance = new_array<OutVectors3>({n, 3}),
         position = new_array<OutVectors3>({n, 3});
    auto pdf = new_array<OutScalars>({n});
    for (size_t i = 0; i < n; ++i) {
        index.data()[i] = -1;
        const vec2 numbers = vec2_at(u, i);
        const auto choice = scene.sample_light_source(kind, vec3_at(reference, i), numbers.x);
        if (!choice) continue;
        const auto sample = choice->light->sample_Li(vec3_at(reference, i), choice->triangle,
                                                     {choice->remapped, numbers.y}, with_mis);
        if (!sample) continue;
        index.data()[i] = static_cast<int32_t>(choice->light - scene.lights().data());
        set_vec3(wi, i, sample->wi);
        set_vec3(radiance, i, sample->radiance);
        set_vec3(position, i, sample->point.position);
        pdf.data()[i] = choice->pmf * sample->pdf;
    }
    nb::dict out;
    out["index"] = index, out["wi"] = wi, out["radiance"] = radiance, out["pdf"] = pdf,
    out["position"] = position;
    return out;
}

auto light_pdf(const Scene& scene, const Vectors3& reference, const Vectors3& wi,
               const std::string& light_choice, bool with_mis) {
    require_same_length(reference.shape(0), wi.shape(0), "reference and wi");
    const size_t n = reference.shape(0);
    const LightSampler::Kind kind = light_choice_named(light_choice);
    auto index = new_array<Out<int32_t, nb::shape<-1>>>({n});
    auto pdf = new_array<OutScalars>({n});
    for (size_t i = 0; i < n; ++i) {
        const vec3 from = vec3_at(reference, i);
        const SurfaceHit hit = scene.intersect({from, vec3_at(wi, i)});
        index.data()[i] = hit.light ? static_cast<int32_t>(hit.light - scene.lights().data()) : -1;
        if (hit.light)
            pdf.data()[i] = scene.light_source_pdf(kind, from, hit.light, hit.triangle) *
                            hit.light->pdf_Li(hit, with_mis);
    }
    return std::pair{index, pdf};
}

std::vector<PythonLight> lights_of(const std::shared_ptr<Scene>& scene) {
    std::vector<PythonLight> lights;
    lights.reserve(scene->lights().size());
    for (size_t i = 0; i < scene->lights().size(); ++i) lights.push_back({scene, i});
    return lights;
}

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

void bind_queries(nb::module_& m) {
    // The scene's class is bound with its construction; what it can be asked is added to it here.
    auto scene = nb::borrow<nb::class_<Scene>>(m.attr("Scene"));
    scene.def_prop_ro("lights", &lights_of, "All lights, area lights in the order of their meshes.");
    scene.def("intersect", &intersect, nb::arg("origin"), nb::arg("direction"),
              "float32 (n, 3), unit (n, 3). Returns a dict of distance (n,) (inf: miss), position (n, 3), "
              "normal and shading_normal\n"
              "(n, 3) on the ray's side, uv (n, 2) and material (n,) int32 (-1: miss).");
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
    scene.def(
        "sample_light_source",
        [](const Scene& self, const Vectors3& reference, const Scalars& u, const std::string& kind) {
            require_same_length(reference.shape(0), u.shape(0), "reference and u");
            const LightSampler::Kind light_choice = light_choice_named(kind);
            auto index = new_array<Out<int32_t, nb::shape<-1>>>({u.shape(0)});
            auto triangle = new_array<Out<int32_t, nb::shape<-1>>>({u.shape(0)});
            auto pmf = new_array<OutScalars>({u.shape(0)});
            for (size_t i = 0; i < u.shape(0); ++i) {
                const auto choice =
                    self.sample_light_source(light_choice, vec3_at(reference, i), u.data()[i]);
                index.data()[i] = choice ? static_cast<int32_t>(choice->light - self.lights().data()) : -1;
                triangle.data()[i] = choice ? static_cast<int32_t>(choice->triangle) : -1;
                pmf.data()[i] = choice ? choice->pmf : 0;
            }
            return std::tuple{index, triangle, pmf};
        },
        nb::arg("reference"), nb::arg("u"), nb::arg("light_choice") = "tree",
        "reference: float32 (n, 3). u: float32 (n,) in [0, 1) -> index of the light chosen there and of the "
        "triangle of its\nmesh, int32 (n,), -1 where there is none to choose, and the probability of that "
        "choice "
        "(n,).");
    scene.def("sample_light", &sample_light, nb::arg("reference"), nb::arg("u"),
              nb::arg("light_choice") = "tree", nb::arg("with_mis") = true,
              "reference: float32 (n, 3). u: float32 (n, 2) in [0, 1). One light sample each, as next event "
              "estimation draws it:\na dict of index (n,) int32 of the light, -1 where it failed, wi (n, 3), "
              "radiance "
              "(n, 3), position (n, 3) on the light and\npdf (n,), the choice of the light included. "
              "Occlusion is not "
              "looked at.");
    scene.def(
        "light_pdf", &light_pdf, nb::arg("reference"), nb::arg("wi"), nb::arg("light_choice") = "tree",
        nb::arg("with_mis") = true,
        "float32 (n, 3), (n, 3) -> index (n,) int32 of the light that each ray finds, -1 for none, and (n,): "
        "density of\n`sample_light` at wi.");
    scene.def(
        "light_source_pdf",
        [](const Scene& self, const Vectors3& reference, size_t index, uint32_t triangle,
           const std::string& kind) {
            const Light& light = self.lights().at(index);
            if (triangle >= (light.mesh() ? light.mesh()->triangles.size() : 1))
                throw std::out_of_range("the light has no such triangle");
            const LightSampler::Kind light_choice = light_choice_named(kind);
            auto pmf = new_array<OutScalars>({reference.shape(0)});
            for (size_t i = 0; i < reference.shape(0); ++i)
                pmf.data()[i] = self.light_source_pdf(light_choice, vec3_at(reference, i), &light, triangle);
            return pmf;
        },
        nb::arg("reference"), nb::arg("index"), nb::arg("triangle") = 0, nb::arg("light_choice") = "tree",
        "float32 (n, 3) -> (n,): probability with which sample_light_source chooses this triangle of this "
        "light "
        "there.");
}

/// The weight that a heuristic gives to one of two techniques, for arrays of the pdfs of both.
template <class Weight>
auto over_arrays(Weight weight) {
    return [weight](const std::string& name, const Scalars& own, const Scalars& other) {
        require_same_length(own.shape(0), other.shape(0), "the two pdfs");
        const Mis mis = mis_of(Parameters({mis_parameter()}, {{"mis", name}}));
        auto out = new_array<OutScalars>({own.shape(0)});
        for (size_t i = 0; i < own.shape(0); ++i) out.data()[i] = weight(mis, own.data()[i], other.data()[i]);
        return out;
    };
}

void bind_weights(nb::module_& m) {
    m.def("light_sampling_weight", over_arrays(&light_sampling_weight), nb::arg("mis"), nb::arg("light_pdf"),
          nb::arg("bsdf_pdf"),
          "mis: \"power\", \"balance\" or \"none\". float32 (n,), (n,) -> (n,): weight of a light sample, "
          "light_pdf > 0.");
    m.def("bsdf_sampling_weight", over_arrays(&bsdf_sampling_weight), nb::arg("mis"), nb::arg("bsdf_pdf"),
          nb::arg("light_pdf"),
          "The counterpart: weight of a light that a BSDF sample's ray found, bsdf_pdf > 0.");
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
               size_t pairs) {
                Sampler sampler(sampler_kind(self.kind), self.seed);
                auto out = new_array<Out<float, nb::shape<-1, -1>>>({count, 2 * pairs});
                for (size_t i = 0; i < count; ++i) {
                    sampler.start(pixel, first + i);
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
            "Samples first .. first + count of a pixel: the first `pairs` two-dimensional draws at a vertex "
            "of the path, float32\n"
            "(count, 2 pairs).")
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
            "directions, (n, 3) each.");
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
}

}  // namespace

void bind_study(nb::module_& m) {
    bind_bsdf(m);
    bind_light(m);
    bind_queries(m);
    bind_weights(m);
    bind_sampler(m);
    bind_camera(m);
}

}  // namespace etendue
