// BSDFs on their own, over whole arrays.
#include <nanobind/stl/array.h>

#include "bindings/arrays.h"
#include "gi/bsdf.h"

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
        if (!sample.exists) continue;
        set_vec3(wi, i, sample.wi);
        set_vec3(weight, i, sample.weight);
        pdf.data()[i] = sample.pdf;
        eta2.data()[i] = sample.eta2;
        type.data()[i] = static_cast<uint8_t>(sample.type);
    }
    nb::dict out;
    out["wi"] = wi, out["weight"] = weight, out["pdf"] = pdf, out["eta2"] = eta2, out["type"] = type;
    return out;
}

OutScalars diffuse_share(const PythonBsdf& bsdf, const Scalars& cosines) {
    auto out = new_array<OutScalars>({cosines.shape(0)});
    for (size_t i = 0; i < cosines.shape(0); ++i)
        out.data()[i] = bsdf_diffuse_share(bsdf.kind, bsdf.surface.ior, cosines.data()[i]);
    return out;
}

OutScalars diffuse_share_in_lanes(const PythonBsdf& bsdf, const Scalars& cosines) {
    auto out = new_array<OutScalars>({cosines.shape(0)});
    in_lanes(cosines.shape(0), [&](size_t first, const LaneMask& on) {
        PerLane<float> some{};
        for_lanes(on, [&](int i) { some[i] = cosines.data()[first + static_cast<size_t>(i)]; });
        set_lanes(out, first, on, bsdf_diffuse_shares(on, bsdf.kind, bsdf.surface.ior, lanes_of(some)));
    });
    return out;
}

/// A BSDF's parameters in all lanes.
SurfaceOf<Lanes> in_all_lanes(const Surface& s) {
    return {LaneVec3(s.albedo), s.ior, s.roughness, s.absorb, LaneMask(s.coated), LaneMask(s.front)};
}

nb::tuple values_in_lanes(const PythonBsdf& bsdf, const Vectors3& wo, const Vectors3& wi) {
    require_same_length(wo.shape(0), wi.shape(0), "wo and wi");
    auto f = new_array<OutVectors3>({wo.shape(0), 3});
    auto pdf = new_array<OutScalars>({wo.shape(0)});
    in_lanes(wo.shape(0), [&](size_t first, const LaneMask& on) {
        const auto values = bsdf_values(on, bsdf.kind, in_all_lanes(bsdf.surface), lanes_at(wo, first, on),
                                        lanes_at(wi, first, on));
        set_lanes(f, first, on, values.f);
        set_lanes(pdf, first, on, values.pdf);
    });
    return nb::make_tuple(f, pdf);
}

nb::dict draw_in_lanes(const PythonBsdf& bsdf, const Vectors3& wo, const Vectors3& u) {
    require_same_length(wo.shape(0), u.shape(0), "wo and u");
    const size_t n = wo.shape(0);
    auto wi = new_array<OutVectors3>({n, 3}), weight = new_array<OutVectors3>({n, 3});
    auto pdf = new_array<OutScalars>({n}), eta2 = new_array<OutScalars>({n});
    auto type = new_array<Out<uint8_t, nb::shape<-1>>>({n});
    in_lanes(n, [&](size_t first, const LaneMask& on) {
        const LaneVec3 numbers = lanes_at(u, first, on);
        const auto samples = bsdf_samples(on, bsdf.kind, in_all_lanes(bsdf.surface), lanes_at(wo, first, on),
                                          numbers.x, {numbers.y, numbers.z});
        const LaneMask exists = on && samples.exists;
        set_lanes(wi, first, exists, samples.wi);
        set_lanes(weight, first, exists, samples.weight);
        set_lanes(pdf, first, exists, samples.pdf);
        set_lanes(eta2, first, exists, samples.eta2);
        set_lanes(type, first, exists, samples.type);
    });
    nb::dict out;
    out["wi"] = wi, out["weight"] = weight, out["pdf"] = pdf, out["eta2"] = eta2, out["type"] = type;
    return out;
}

}  // namespace

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
             "type is 0 where sampling failed.")
        .def("diffuse_share", &diffuse_share, nb::arg("cosines"),
             "float32 (n,) -> (n,): what of f is albedo / pi for wo of these cosines, where paths may be "
             "shared.")
        .def("diffuse_share_in_lanes", &diffuse_share_in_lanes, nb::arg("cosines"), "Of many at once.")
        .def("values_in_lanes", &values_in_lanes, nb::arg("wo"), nb::arg("wi"),
             "(f, pdf) of many at once, as the path tracers ask for them.")
        .def("sample_in_lanes", &draw_in_lanes, nb::arg("wo"), nb::arg("u"),
             "As `sample`, of many at once, as the path tracers do.");
    m.attr("LANES") = LANES;
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

}  // namespace etendue
