// Lights, their choice, and what they share with BSDF sampling, over whole arrays.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/shared_ptr.h>
#include <nanobind/stl/tuple.h>

#include "algorithms/direct_light.h"
#include "bindings/arrays.h"
#include "driver/tiles.h"
#include "gi/scene.h"

namespace etendue {

namespace {

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
        if (!sample.exists) continue;
        set_vec3(wi, i, sample.wi);
        set_vec3(radiance, i, sample.radiance);
        set_vec3(position, i, sample.point.position);
        pdf.data()[i] = triangle.pmf * sample.pdf;
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

/// Light samples as arrays.
struct DrawnLights {
    Out<int32_t, nb::shape<-1>> index;
    OutVectors3 wi, radiance, position;
    OutScalars pdf;

    explicit DrawnLights(size_t n)
        : index(new_array<Out<int32_t, nb::shape<-1>>>({n})),
          wi(new_array<OutVectors3>({n, 3})),
          radiance(new_array<OutVectors3>({n, 3})),
          position(new_array<OutVectors3>({n, 3})),
          pdf(new_array<OutScalars>({n})) {}

    nb::dict as_dict() const {
        nb::dict out;
        out["index"] = index, out["wi"] = wi, out["radiance"] = radiance, out["pdf"] = pdf;
        out["position"] = position;
        return out;
    }
};

nb::dict sample_light(const Scene& scene, const Vectors3& reference, const Vectors2& u,
                      const std::string& light_choice, bool with_mis, const LightFactors* learned) {
    require_same_length(reference.shape(0), u.shape(0), "reference and u");
    const size_t n = reference.shape(0);
    const LightSampler::Kind kind = light_choice_named(light_choice);
    DrawnLights drawn(n);
    auto& [index, wi, radiance, position, pdf] = drawn;
    for (size_t i = 0; i < n; ++i) {
        index.data()[i] = -1;
        const vec2 numbers = vec2_at(u, i);
        const auto choice = scene.sample_light_source(kind, vec3_at(reference, i), numbers.x, learned);
        if (!choice) continue;
        const auto sample = choice->light->sample_Li(vec3_at(reference, i), choice->triangle,
                                                     {choice->remapped, numbers.y}, with_mis);
        if (!sample.exists) continue;
        index.data()[i] = static_cast<int32_t>(choice->light - scene.lights().data());
        set_vec3(wi, i, sample.wi);
        set_vec3(radiance, i, sample.radiance);
        set_vec3(position, i, sample.point.position);
        pdf.data()[i] = choice->pmf * sample.pdf;
    }
    return drawn.as_dict();
}

nb::dict sample_light_in_lanes(const Scene& scene, const Vectors3& reference, const Vectors2& u,
                               const std::string& light_choice, bool with_mis, const LightFactors* learned) {
    require_same_length(reference.shape(0), u.shape(0), "reference and u");
    const size_t n = reference.shape(0);
    const LightSampler::Kind kind = light_choice_named(light_choice);
    DrawnLights drawn(n);
    auto& [index, wi, radiance, position, pdf] = drawn;
    PerLane<const LightFactors*> all_learned;
    all_learned.fill(learned);
    in_lanes(n, [&](size_t first, const LaneMask& on) {
        PerLane<double> numbers{};
        PerLane<float> along{}, across{}, pmf{};
        PerLane<bool> chosen{};
        PerLane<const Light*> lights{};
        PerLane<uint32_t> triangles{};
        for_lanes(on, [&](int i) {
            numbers[i] = u.data()[2 * (first + i)], across[i] = u.data()[2 * (first + i) + 1];
        });
        const LaneVec3 references = lanes_at(reference, first, on);
        const auto choices = scene.light_sampler().sample(kind, on, references, numbers, all_learned);
        for_lanes(on, [&](int i) {
            index.data()[first + i] = -1;
            const auto& choice = choices[i];
            if (!choice) return;
            chosen[i] = true;
            lights[i] = choice->light, triangles[i] = choice->triangle;
            along[i] = choice->remapped, pmf[i] = choice->pmf;
        });
        const LightSampleOf<Lanes> samples = Light::sample_Li(mask_of(chosen), references, lights, triangles,
                                                              {lanes_of(along), lanes_of(across)}, with_mis);
        for_lanes(samples.exists, [&](int i) {
            index.data()[first + i] = static_cast<int32_t>(lights[i] - scene.lights().data());
        });
        set_lanes(wi, first, samples.exists, samples.wi);
        set_lanes(radiance, first, samples.exists, samples.radiance);
        set_lanes(position, first, samples.exists, samples.point.position);
        set_lanes(pdf, first, samples.exists, lanes_of(pmf) * samples.pdf);
    });
    return drawn.as_dict();
}

auto light_pdf(const Scene& scene, const Vectors3& reference, const Vectors3& wi,
               const std::string& light_choice, bool with_mis, const LightFactors* learned) {
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
            pdf.data()[i] = scene.light_source_pdf(kind, from, hit.light, hit.triangle, learned) *
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

void bind_choice(nb::module_& m) {
    // The scene's class is bound with its construction; what it can be asked is added to it here.
    auto scene = nb::borrow<nb::class_<Scene>>(m.attr("Scene"));
    scene.def_prop_ro("lights", &lights_of, "All lights, area lights in the order of their meshes.");
    scene.def(
        "sample_light_source",
        [](const Scene& self, const Vectors3& reference, const Scalars& u, const std::string& kind,
           const LightFactors* learned) {
            require_same_length(reference.shape(0), u.shape(0), "reference and u");
            const LightSampler::Kind light_choice = light_choice_named(kind);
            auto index = new_array<Out<int32_t, nb::shape<-1>>>({u.shape(0)});
            auto triangle = new_array<Out<int32_t, nb::shape<-1>>>({u.shape(0)});
            auto pmf = new_array<OutScalars>({u.shape(0)});
            for (size_t i = 0; i < u.shape(0); ++i) {
                const auto choice =
                    self.sample_light_source(light_choice, vec3_at(reference, i), u.data()[i], learned);
                index.data()[i] = choice ? static_cast<int32_t>(choice->light - self.lights().data()) : -1;
                triangle.data()[i] = choice ? static_cast<int32_t>(choice->triangle) : -1;
                pmf.data()[i] = choice ? choice->pmf : 0;
            }
            return std::tuple{index, triangle, pmf};
        },
        nb::arg("reference"), nb::arg("u"), nb::arg("light_choice") = "tree",
        nb::arg("learned").none() = nb::none(),
        "reference: float32 (n, 3). u: float32 (n,) in [0, 1) -> index of the light chosen there and of the "
        "triangle of its\nmesh, int32 (n,), -1 where there is none to choose, and the probability of that "
        "choice "
        "(n,).");
    scene.def("sample_light", &sample_light, nb::arg("reference"), nb::arg("u"),
              nb::arg("light_choice") = "tree", nb::arg("with_mis") = true,
              nb::arg("learned").none() = nb::none(),
              "reference: float32 (n, 3). u: float32 (n, 2) in [0, 1). One light sample each, as next event "
              "estimation draws it:\na dict of index (n,) int32 of the light, -1 where it failed, wi (n, 3), "
              "radiance "
              "(n, 3), position (n, 3) on the light and\npdf (n,), the choice of the light included. "
              "Occlusion is not "
              "looked at.");
    scene.def("sample_light_in_lanes", &sample_light_in_lanes, nb::arg("reference"), nb::arg("u"),
              nb::arg("light_choice") = "tree", nb::arg("with_mis") = true,
              nb::arg("learned").none() = nb::none(),
              "As `sample_light`, of many at once, as the path tracers do.");
    scene.def(
        "light_pdf", &light_pdf, nb::arg("reference"), nb::arg("wi"), nb::arg("light_choice") = "tree",
        nb::arg("with_mis") = true, nb::arg("learned").none() = nb::none(),
        "float32 (n, 3), (n, 3) -> index (n,) int32 of the light that each ray finds, -1 for none, and (n,): "
        "density of\n`sample_light` at wi.");
    scene.def(
        "light_source_pdf",
        [](const Scene& self, const Vectors3& reference, size_t index, uint32_t triangle,
           const std::string& kind, const LightFactors* learned) {
            const Light& light = self.lights().at(index);
            if (triangle >= (light.mesh() ? light.mesh()->triangles.size() : 1))
                throw std::out_of_range("the light has no such triangle");
            const LightSampler::Kind light_choice = light_choice_named(kind);
            auto pmf = new_array<OutScalars>({reference.shape(0)});
            for (size_t i = 0; i < reference.shape(0); ++i)
                pmf.data()[i] =
                    self.light_source_pdf(light_choice, vec3_at(reference, i), &light, triangle, learned);
            return pmf;
        },
        nb::arg("reference"), nb::arg("index"), nb::arg("triangle") = 0, nb::arg("light_choice") = "tree",
        nb::arg("learned").none() = nb::none(),
        "float32 (n, 3) -> (n,): probability with which sample_light_source chooses this triangle of this "
        "light "
        "there.");
}

using OfSlots = std::array<float, LightTree::WIDTH>;

LightFactors make_factors(float triangles_share, const OfSlots& root,
                          const std::array<OfSlots, LightTree::WIDTH>& below) {
    const auto positive = [](const OfSlots& slots) {
        return std::ranges::all_of(slots, [](float factor) { return factor > 0 && factor < INFINITE; });
    };
    if (!(triangles_share > 0 && triangles_share <= 1))
        throw std::invalid_argument("triangles_share: above 0 and at most 1 is needed");
    if (!positive(root) || !std::ranges::all_of(below, positive))
        throw std::invalid_argument("factors: finite numbers above 0 are needed");
    LightFactors factors{triangles_share, {LightTree::SlotFactors(root), {}}};
    std::ranges::transform(below, factors.tree.below.begin(),
                           [](const OfSlots& slots) { return LightTree::SlotFactors(slots); });
    return factors;
}

OfSlots of_slots(const LightTree::SlotFactors& factors) {
    OfSlots all;
    for (uint32_t i = 0; i < LightTree::WIDTH; ++i) all[i] = factors[i];
    return all;
}

void bind_guide(nb::module_& m) {
    nb::class_<LightFactors>(
        m, "LightFactors",
        "What was learned about the lights of a region of a scene: what the importances of the light tree's "
        "first two levels\nare multiplied by.")
        .def(
            nb::new_(&make_factors), nb::arg("triangles_share"), nb::arg("root"), nb::arg("below"),
            "triangles_share: probability of choosing a triangle rather than another light, 1 without "
            "others. root: 16 numbers,\nfor the slots of the root. below: 16 of 16, for the slots of what is "
            "below each. Raises ValueError unless all are > 0.")
        .def_ro("triangles_share", &LightFactors::triangles_share)
        .def_prop_ro("root", [](const LightFactors& f) { return of_slots(f.tree.root); })
        .def_prop_ro("below", [](const LightFactors& f) {
            std::array<OfSlots, LightTree::WIDTH> all;
            std::ranges::transform(f.tree.below, all.begin(), of_slots);
            return all;
        });
    nb::class_<LightGuide>(m, "LightGuide",
                           "Where light does arrive from, region by region (`light_choice`: learned).")
        .def(
            "__init__",
            [](LightGuide* self, const Scene& scene, const Camera& camera, int max_edges, int threads) {
                const nb::gil_scoped_release release;
                new (self) LightGuide;
                TileWorkers workers(thread_count(threads));
                self->learn({scene, camera,
                             [&](uint32_t count, const std::function<void(uint32_t)>& work) {
                                 workers.in_order(count, work);
                                 return true;
                             }},
                            max_edges, Mis::power);
            },
            nb::arg("scene"), nb::arg("camera"), nb::arg("max_edges") = 10, nb::arg("threads") = 0,
            "Learns from paths of that camera, as a render by Pathtracer does before its first sample.")
        .def_static("paths", &LightGuide::paths, nb::arg("camera"), "How many paths it traces for that.")
        .def(
            "at",
            [](const LightGuide& self, const std::array<float, 3>& position,
               const std::array<float, 3>& normal) { return self.at(to_vec3(position), to_vec3(normal)); },
            nb::rv_policy::reference_internal, nb::arg("position"), nb::arg("normal"),
            "The LightFactors for a point and its unit normal; None where nothing is known.");
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
    m.def("light_sampling_weight", over_arrays(&light_sampling_weight<float>), nb::arg("mis"),
          nb::arg("light_pdf"), nb::arg("bsdf_pdf"),
          "mis: \"power\", \"balance\" or \"none\". float32 (n,), (n,) -> (n,): weight of a light sample, "
          "light_pdf > 0.");
    m.def("bsdf_sampling_weight", over_arrays(&bsdf_sampling_weight<float>), nb::arg("mis"),
          nb::arg("bsdf_pdf"), nb::arg("light_pdf"),
          "The counterpart: weight of a light that a BSDF sample's ray found, bsdf_pdf > 0.");
}

}  // namespace

void bind_lights(nb::module_& m) {
    bind_light(m);
    bind_guide(m);
    bind_choice(m);
    bind_weights(m);
}

}  // namespace etendue
