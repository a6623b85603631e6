#include "gi/light.h"

namespace etendue {

namespace {

template <class... Kinds>
void find_each(const LightContext& context, std::vector<Light>& lights, std::variant<Kinds...>*) {
    const auto add = [&](auto found) {
        for (auto& light : found) lights.emplace_back(std::move(light));
    };
    (add(Kinds::find(context)), ...);
}

LightSampleOf<Lanes> merged(const LaneMask& mask, const LightSampleOf<Lanes>& a,
                            const LightSampleOf<Lanes>& b) {
    return {select(mask, a.exists, b.exists),
            select(mask, a.radiance, b.radiance),
            select(mask, a.wi, b.wi),
            select(mask, a.pdf, b.pdf),
            {select(mask, a.point.position, b.point.position), select(mask, a.point.normal, b.point.normal),
             select(mask, a.point.reach, b.point.reach)},
            select(mask, a.infinite, b.infinite)};
}

/// Of a kind of light that knows nothing of lanes, one after the other.
template <class Kind>
LightSampleOf<Lanes> sample_each(const LaneMask& on, const LaneVec3& reference,
                                 const PerLane<const Kind*>& lights, const PerLane<uint32_t>& triangles,
                                 const LaneVec2& u, bool with_mis) {
    PerLane<bool> exists{}, infinite{};
    VectorArrays radiance, wi, position, normal;
    PerLane<float> pdf{}, reach{};
    for_lanes(on, [&](int i) {
        const LightSample sample =
            lights[i]->sample_Li(reference.lane(i), triangles[i], {u.x[i], u.y[i]}, with_mis);
        exists[i] = sample.exists, infinite[i] = sample.infinite;
        radiance.set(i, sample.radiance), wi.set(i, sample.wi);
        position.set(i, sample.point.position), normal.set(i, sample.point.normal);
        pdf[i] = sample.pdf, reach[i] = sample.point.reach;
    });
    return {mask_of(exists),
            radiance.lanes(),
            wi.lanes(),
            lanes_of(pdf),
            {position.lanes(), normal.lanes(), lanes_of(reach)},
            mask_of(infinite)};
}

template <class Kind>
FoundLightOf<Lanes> found_each(const LaneMask& on, const SurfaceHits& hits,
                               const PerLane<const Kind*>& lights, bool with_mis) {
    VectorArrays radiance;
    PerLane<float> pdf{};
    for_lanes(on, [&](int i) {
        const SurfaceHit hit = hits.seen_by_light(i);
        radiance.set(i, hit.valid ? lights[i]->Le(hit) : lights[i]->Le(-hit.wo));
        pdf[i] = lights[i]->pdf_Li(hit, with_mis);
    });
    return {radiance.lanes(), lanes_of(pdf)};
}

}  // namespace

template <class Visit>
void Light::for_kinds(const LaneMask& on, const PerLane<const Light*>& lights, const Visit& visit) {
    PerLane<size_t> kinds{};
    for_lanes(on, [&](int i) { kinds[i] = lights[i]->kind_.index(); });
    const auto visit_kind = [&]<size_t kind>(std::integral_constant<size_t, kind>) {
        PerLane<bool> is_of_kind;
        for (int i = 0; i < LANES; ++i) is_of_kind[i] = kinds[i] == kind;
        const LaneMask mask = on && mask_of(is_of_kind);
        if (!any(mask)) return;
        PerLane<const std::variant_alternative_t<kind, Kinds>*> of_kind{};
        for_lanes(mask, [&](int i) { of_kind[i] = std::get_if<kind>(&lights[i]->kind_); });
        visit(mask, of_kind);
    };
    [&]<size_t... kind>(std::index_sequence<kind...>) {
        (visit_kind(std::integral_constant<size_t, kind>()), ...);
    }(std::make_index_sequence<std::variant_size_v<Kinds>>());
}

LightSampleOf<Lanes> Light::sample_Li(const LaneMask& on, const LaneVec3& reference,
                                      const PerLane<const Light*>& lights, const PerLane<uint32_t>& triangles,
                                      const LaneVec2& u, bool with_mis) {
    LightSampleOf<Lanes> out;
    for_kinds(on, lights, [&]<class Kind>(const LaneMask& mask, const PerLane<const Kind*>& of_kind) {
        if constexpr (requires { Kind::sample_Li(mask, reference, of_kind, triangles, u, with_mis); })
            out = merged(mask, Kind::sample_Li(mask, reference, of_kind, triangles, u, with_mis), out);
        else
            out = merged(mask, sample_each(mask, reference, of_kind, triangles, u, with_mis), out);
    });
    return out;
}

FoundLightOf<Lanes> Light::found(const LaneMask& on, const SurfaceHits& hits, bool with_mis) {
    FoundLightOf<Lanes> out;
    for_kinds(on, hits.found.light,
              [&]<class Kind>(const LaneMask& mask, const PerLane<const Kind*>& of_kind) {
                  FoundLightOf<Lanes> found;
                  if constexpr (requires { Kind::found(mask, hits, of_kind, with_mis); })
                      found = Kind::found(mask, hits, of_kind, with_mis);
                  else
                      found = found_each(mask, hits, of_kind, with_mis);
                  out.radiance = select(mask, found.radiance, out.radiance);
                  out.pdf = select(mask, found.pdf, out.pdf);
              });
    return out;
}

std::vector<Light> Light::find_all(const LightContext& context) {
    std::vector<Light> lights;
    find_each(context, lights, static_cast<Kinds*>(nullptr));
    return lights;
}

}  // namespace etendue
