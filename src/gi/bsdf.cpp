#include "gi/bsdf.h"

#include <stdexcept>
#include <vector>

#include "bsdf_list.h"  // made by CMakeLists.txt: includes bsdfs/*.h and defines ETENDUE_BSDFS

namespace etendue {

namespace {

/// Calls `visit` with the BSDF of this kind: a switch that the compiler unrolls, so that each case is
/// inlined.
template <class... Types>
struct List {
    template <class Result, class Visit>
    static Result dispatch(BsdfKind kind, Visit&& visit) {
        return dispatch_from<Result, 0, Types...>(kind, visit);
    }
    template <class Result, BsdfKind i, class First, class... Rest>
    static Result dispatch_from(BsdfKind kind, auto& visit) {
        if constexpr (sizeof...(Rest) > 0) {
            if (kind != i) return dispatch_from<Result, i + 1, Rest...>(kind, visit);
        }
        return visit(First{});
    }

    /// Calls visit(bsdf, mask) for every BSDF that some lanes are of.
    static void for_kinds(const LaneMask& on, const Lanes& kinds, auto&& visit) {
        BsdfKind kind = 0;
        const auto for_kind = [&](auto bsdf) {
            const LaneMask mask = on && kinds == static_cast<float>(kind++);
            if (any(mask)) visit(bsdf, mask);
        };
        (for_kind(Types{}), ...);
    }

    static std::vector<BsdfInfo> infos() {
        return {{Types::name, Types::summary, Types::is_delta, Types::is_reciprocal}...};
    }

    static std::vector<NamedMaterialType> types() {
        std::vector<NamedMaterialType> all;
        BsdfKind kind = 0;
        const auto add = [&](std::span<const MaterialType> types) {
            for (const MaterialType& type : types) all.push_back({type, kind});
            ++kind;
        };
        (add(Types::types), ...);
        std::ranges::stable_sort(all, {}, [](const NamedMaterialType& t) { return t.type.order; });
        return all;
    }
};
using Bsdfs = List<ETENDUE_BSDFS>;

}  // namespace

vec3 bsdf_albedo(BsdfKind kind, const Surface& surface) {
    return Bsdfs::dispatch<vec3>(kind, [&](auto bsdf) { return decltype(bsdf)::albedo(surface); });
}

vec3 bsdf_f(BsdfKind kind, const Surface& surface, const vec3& wo, const vec3& wi) {
    return Bsdfs::dispatch<vec3>(kind, [&](auto bsdf) { return decltype(bsdf)::f(surface, wo, wi); });
}

float bsdf_pdf(BsdfKind kind, const Surface& surface, const vec3& wo, const vec3& wi) {
    return Bsdfs::dispatch<float>(kind, [&](auto bsdf) { return decltype(bsdf)::pdf(surface, wo, wi); });
}

BsdfSample bsdf_sample(BsdfKind kind, const Surface& surface, const vec3& wo, float lobe, const vec2& u) {
    return Bsdfs::dispatch<BsdfSample>(
        kind, [&](auto bsdf) { return decltype(bsdf)::sample(surface, wo, lobe, u); });
}

float bsdf_diffuse_share(BsdfKind kind, float ior, float cos_o) {
    return Bsdfs::dispatch<float>(kind, [&](auto bsdf) { return decltype(bsdf)::diffuse_share(ior, cos_o); });
}

bool bsdf_is_delta(BsdfKind kind) {
    return Bsdfs::dispatch<bool>(kind, [](auto bsdf) { return decltype(bsdf)::is_delta; });
}

ETENDUE_LANES_FLATTEN BsdfValueOf<Lanes> bsdf_values(const LaneMask& on, const Lanes& kinds,
                                                     const SurfaceOf<Lanes>& surfaces, const LaneVec3& wo,
                                                     const LaneVec3& wi) {
    BsdfValueOf<Lanes> out;
    Bsdfs::for_kinds(on, kinds, [&](auto bsdf, const LaneMask& mask) {
        out.f = select(mask, decltype(bsdf)::f(surfaces, wo, wi), out.f);
        out.pdf = select(mask, decltype(bsdf)::pdf(surfaces, wo, wi), out.pdf);
    });
    return out;
}

ETENDUE_LANES_FLATTEN BsdfSampleOf<Lanes> bsdf_samples(const LaneMask& on, const Lanes& kinds,
                                                       const SurfaceOf<Lanes>& surfaces, const LaneVec3& wo,
                                                       const Lanes& lobe, const LaneVec2& u) {
    BsdfSampleOf<Lanes> out;
    Bsdfs::for_kinds(on, kinds, [&](auto bsdf, const LaneMask& mask) {
        const BsdfSampleOf<Lanes> sample = decltype(bsdf)::sample(surfaces, wo, lobe, u);
        out.exists = select(mask, sample.exists, out.exists);
        out.wi = select(mask, sample.wi, out.wi);
        out.weight = select(mask, sample.weight, out.weight);
        out.pdf = select(mask, sample.pdf, out.pdf);
        out.type = select(mask, sample.type, out.type);
        out.eta2 = select(mask, sample.eta2, out.eta2);
    });
    return out;
}

Lanes bsdf_diffuse_shares(const LaneMask& on, const Lanes& kinds, const Lanes& iors, const Lanes& cos_o) {
    Lanes out = 0;
    Bsdfs::for_kinds(on, kinds, [&](auto bsdf, const LaneMask& mask) {
        out = select(mask, decltype(bsdf)::diffuse_share(iors, cos_o), out);
    });
    return out;
}

std::span<const BsdfInfo> bsdfs() {
    static const std::vector<BsdfInfo> all = Bsdfs::infos();
    return all;
}

std::span<const NamedMaterialType> material_types() {
    static const std::vector<NamedMaterialType> all = Bsdfs::types();
    return all;
}

BsdfKind bsdf_of(std::string_view name) {
    for (const NamedMaterialType& t : material_types()) {
        if (t.type.name == name) return t.bsdf;
    }
    for (BsdfKind kind = 0; kind < bsdfs().size(); ++kind) {
        if (bsdfs()[kind].name == name) return kind;
    }
    throw std::invalid_argument("there is no material type \"" + std::string(name) + "\"");
}

}  // namespace etendue
