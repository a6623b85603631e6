// What there is to choose from: estimators with their parameters, material types, samplers, filters.
#include <nanobind/stl/array.h>
#include <nanobind/stl/pair.h>
#include <nanobind/stl/variant.h>
#include <oneapi/tbb/version.h>

#include "algorithms/algorithm.h"
#include "bindings/arrays.h"
#include "gi/filter.h"
#include "gi/scene.h"

namespace etendue {

namespace {

struct ParameterInfo : Parameter {
    std::string kind() const {
        static const char* const kinds[] = {"bool", "int", "float", "choice"};
        return kinds[default_value.index()];
    }
};

struct PythonAlgorithmInfo {
    std::string name, summary;
    std::vector<ParameterInfo> parameters;
    std::optional<int> longest_path;
};

std::optional<float> unless_keep(float value) {
    return value == MaterialType::KEEP ? std::nullopt : std::optional(value);
}

/// The widest vector instructions that this core was compiled for.
const char* instruction_set() {
#if defined(__AVX512F__)
    return "AVX-512";
#elif defined(__AVX2__)
    return "AVX2";
#elif defined(__AVX__)
    return "AVX";
#else
    return "SSE2";
#endif
}

template <class Names>
std::vector<std::string> strings(const Names& names) {
    return {names.begin(), names.end()};
}

}  // namespace

void bind_registry(nb::module_& m) {
    nb::class_<ParameterInfo>(m, "ParameterInfo",
                              "A setting of an estimator: a top-level key of the scene file.")
        .def_ro("name", &ParameterInfo::name)
        .def_ro("summary", &ParameterInfo::summary)
        .def_prop_ro("kind", &ParameterInfo::kind, "\"bool\", \"int\", \"float\" or \"choice\".")
        .def_ro("default", &ParameterInfo::default_value)
        .def_ro("choices", &ParameterInfo::choices, "The values of a choice.")
        .def_ro("minimum", &ParameterInfo::minimum, "Of a number.")
        .def_ro("maximum", &ParameterInfo::maximum, "Of a number.");
    nb::class_<PythonAlgorithmInfo>(m, "AlgorithmInfo", "An estimator.")
        .def_ro("name", &PythonAlgorithmInfo::name)
        .def_ro("summary", &PythonAlgorithmInfo::summary)
        .def_ro("parameters", &PythonAlgorithmInfo::parameters)
        .def_ro("longest_path", &PythonAlgorithmInfo::longest_path,
                "Edges of the longest path it takes in, whatever max_cam_path_length says: None for no "
                "limit, 2 for direct\n"
                "light, 0 where it pictures something else than light transport.");
    m.def(
        "algorithms",
        [] {
            std::vector<PythonAlgorithmInfo> all;
            for (const auto& [name, info] : algorithms()) {
                PythonAlgorithmInfo python{name, info.summary, {}, {}};
                if (info.longest_path != AlgorithmInfo::UNLIMITED) python.longest_path = info.longest_path;
                for (const Parameter& p : info.parameters) python.parameters.push_back({p});
                all.push_back(std::move(python));
            }
            return all;
        },
        "All estimators, by name.");

    nb::class_<NamedMaterialType>(m, "MaterialType", "What the name of a material makes of it.")
        .def_prop_ro("name", [](const NamedMaterialType& t) { return std::string(t.type.name); })
        .def_prop_ro("summary", [](const NamedMaterialType& t) { return std::string(t.type.summary); })
        .def_prop_ro(
            "bsdf", [](const NamedMaterialType& t) { return std::string(bsdfs()[t.bsdf].name); },
            "Name of the BSDF.")
        .def_prop_ro(
            "matches",
            [](const NamedMaterialType& t) {
                std::vector<std::string> texts;
                for (const auto& text : t.type.match) {
                    if (!text.empty()) texts.emplace_back(text);
                }
                return texts;
            },
            "Lower-case texts, any of which the name may contain; none: every name matches.")
        .def_prop_ro(
            "ior", [](const NamedMaterialType& t) { return unless_keep(t.type.ior); },
            "None: the mesh's own.")
        .def_prop_ro("absorb", [](const NamedMaterialType& t) { return unless_keep(t.type.absorb); })
        .def_prop_ro("roughness", [](const NamedMaterialType& t) { return unless_keep(t.type.roughness); })
        .def_prop_ro(
            "emissive_strength",
            [](const NamedMaterialType& t) { return unless_keep(t.type.emissive_strength); },
            "Where the mesh gives none.")
        .def_prop_ro("albedo", [](const NamedMaterialType& t) -> std::optional<std::array<float, 3>> {
            const float* const c = t.type.albedo;
            if (c[0] == MaterialType::KEEP) return std::nullopt;
            return std::array{c[0], c[1], c[2]};
        });
    m.def(
        "material_types",
        [] { return std::vector<NamedMaterialType>(material_types().begin(), material_types().end()); },
        "All material types, in the order in which names are tried against them; the first match decides.");
    m.def("samplers", [] { return strings(Sampler::names); }, "Names of the samplers, the default first.");
    m.def("filters", [] { return strings(Filter::names); }, "Names of the pixel filters, the default first.");
    m.def(
        "versions",
        [] {
            return std::vector<std::pair<std::string, std::string>>{{"Embree", embree_version()},
                                                                    {"oneTBB", TBB_runtime_version()},
                                                                    {"compiler", __VERSION__},
                                                                    {"instruction set", instruction_set()}};
        },
        "What the core was built with and runs on, as (name, version).");
}

}  // namespace etendue
