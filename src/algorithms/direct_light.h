// Next event estimation at one vertex: light sampled on purpose, and the weight that it shares with light
// found by chance.
#pragma once

#include "algorithms/lane_context.h"
#include "algorithms/light_guide.h"

namespace etendue {

/// How light sampling and BSDF sampling share the light that both can find (assignment 4).
enum class Mis { power, balance, none };

inline Mis mis_of(const Parameters& parameters) {
    const auto name = parameters.get<std::string>("mis");
    return name == "power" ? Mis::power : name == "balance" ? Mis::balance : Mis::none;
}

inline Parameter mis_parameter() {
    return {"mis",
            "how light sampling and BSDF sampling are combined; none: light sampling alone",
            std::string("power"),
            0,
            0,
            {"power", "balance", "none"}};
}

inline Parameter light_splitting_parameter() {
    return {
        "light_splitting",
        "whether up to four lights are sampled, not one, at the first surface of each path, where that pays",
        true,
        0,
        0,
        {}};
}

/// How an estimator chooses its lights.
class LightChoice {
  public:
    explicit LightChoice(const Parameters& parameters) {
        const auto name = parameters.get<std::string>("light_choice");
        kind_ = name == "power" ? LightSampler::Kind::power : LightSampler::Kind::tree;
        learns_ = name == "learned";
    }

    static Parameter parameter() {
        return {
            "light_choice",
            "how a light is chosen; learned: by how much of its light does arrive, which a moment of tracing "
            "tells before; tree: by how much could arrive; power: by its power alone",
            std::string("learned"),
            0,
            0,
            {"learned", "tree", "power"}};
    }

    // See Algorithm.
    bool learns(const Scene& scene) const { return learns_ && !scene.light_sampler().tree().empty(); }
    bool prepare(const Preparation& preparation, int max_edges, Mis mis) {
        guide_ = {};
        return guide_.learn(preparation, max_edges, mis);
    }

    LightSampler::Kind kind() const { return kind_; }
    /// What is known of the region of a vertex; null: no more than what the scene itself knows.
    const LightFactors* learned(const SurfaceHit& hit) const {
        return guide_.at(hit.point.position, hit.frame.n);
    }
    PerLane<const LightFactors*> learned(const SurfaceHits& hits, const LaneMask& on) const {
        return guide_.at(on, hits.point.position, hits.frame.n);
    }

  private:
    LightSampler::Kind kind_;
    bool learns_;
    LightGuide guide_;
};

/// Weight of light sampling for a light sample: 1 without MIS.
template <class F>
F light_sampling_weight(Mis mis, const F& light_pdf, const F& bsdf_pdf) {
    switch (mis) {
        case Mis::power:
            return power_heuristic(light_pdf, bsdf_pdf);
        case Mis::balance:
            return balance_heuristic(light_pdf, bsdf_pdf);
        case Mis::none:
            return 1;
    }
    return 1;
}

/// Weight of BSDF sampling for a light that its ray hit; the counterpart of the above, so 0 without MIS.
/// A light that could not have been sampled from there has light_pdf 0 and counts in full.
template <class F>
F bsdf_sampling_weight(Mis mis, const F& bsdf_pdf, const F& light_pdf) {
    switch (mis) {
        case Mis::power:
            return power_heuristic(bsdf_pdf, light_pdf);
        case Mis::balance:
            return balance_heuristic(bsdf_pdf, light_pdf);
        case Mis::none:
            return select(light_pdf > 0, F(0), F(1));
    }
    return 1;
}

/// Light that arrives at a vertex if nothing is between: the question, and what is found then.
template <class F>
struct ConnectionOf {
    Mask<F> exists{false};
    RayOf<F> shadow_ray;
    ContributionOf<F> found;
    Vec3<F> f;           // the vertex's BSDF towards the light
    Vec3<F> irradiance;  // |cos| radiance / pdf: of the vertex, before its BSDF
};

/// From a vertex to a place on a light, to which `pmf` samples go in the mean; `bsdf`: in that direction. The throughput
/// is the vertex's, at the end of a path of one edge less than `edges`.
template <class F>
ConnectionOf<F> connection(const SurfacePointOf<F>& point, const Vec3<F>& shading_normal,
                           const LightSampleOf<F>& light, const F& pmf, const BsdfValueOf<F>& bsdf,
                           const Vec3<F>& throughput, const F& edges, Mis mis) {
    const F cos = abs(dot(light.wi, shading_normal));
    const Vec3<F> reflected = bsdf.f * cos * light.radiance;
    ContributionOf<F> found{Technique::light_sampling, edges};
    found.pdf = pmf * light.pdf;
    found.other_pdf = bsdf.pdf;
    found.weight = light_sampling_weight(mis, found.pdf, found.other_pdf);
    found.unweighted = throughput * reflected / found.pdf;
    return {light.exists && !is_black(reflected), shadow_ray(point, light), found, bsdf.f,
            light.radiance * (cos / found.pdf)};
}

/// One number chooses the light and the place along it, so that samples which are stratified over [0, 1) are so over each
/// light too. What of its digits the choice uses up, others make up for.
inline double light_number(float u, float finer_digits) { return u + double{finer_digits} * 0x1p-24; }

/// A light chosen for a vertex, if there was one to choose, and the number that is left for a place on it.
struct ChosenLight {
    std::optional<LightSampler::Choice> choice;
    float across;
};

inline ChosenLight choose_light(Context& context, const SurfaceHit& hit, LightSampler::Kind kind,
                                const LightFactors* learned) {
    const float finer_digits = context.sampler.next_1d();
    const vec2 u = context.sampler.next_2d();
    const double number = light_number(u.x, finer_digits);
    return {context.scene.sample_light_source(kind, hit.point.position, number, learned), u.y};
}

/// To a place on a chosen light.
inline ConnectionOf<float> connect(const SurfaceHit& hit, const LightSampler::Choice& choice, float across,
                                   const vec3& throughput, float edges, Mis mis) {
    const LightSample light = choice.light->sample_Li(hit.point.position, choice.triangle,
                                                      {choice.remapped, across}, mis != Mis::none);
    if (!light.exists) return {};
    const BsdfValueOf<float> bsdf{hit.f(light.wi), hit.pdf(light.wi)};
    return connection(hit.point, hit.frame.n, light, choice.pmf, bsdf, throughput, edges, mis);
}

/// The same, to a light that is chosen first. None at delta surfaces, where a sampled light could never be seen.
inline ConnectionOf<float> connect_to_light(Context& context, const SurfaceHit& hit, const vec3& throughput,
                                            float edges, LightSampler::Kind kind, const LightFactors* learned,
                                            Mis mis) {
    if (hit.is_type(BRDF_SPECULAR)) return {};
    const auto [choice, across] = choose_light(context, hit, kind, learned);
    return choice ? connect(hit, *choice, across, throughput, edges, mis) : ConnectionOf<float>();
}

/// And for the vertices of several paths, those that are `on`. `light_samples`: of how many at
/// each vertex this is one.
ConnectionOf<Lanes> connect_to_lights(LaneContext& context, const SurfaceHits& hits, const LaneMask& on,
                                      const LaneVec3& throughput, const Lanes& edges, LightSampler::Kind kind,
                                      const PerLane<const LightFactors*>& learned, Mis mis,
                                      float light_samples = 1);

/// What arrives over a connection, for which its shadow ray is traced.
inline vec3 light_over(Context& context, const ConnectionOf<float>& connection) {
    return connection.exists && context.visible(connection.shadow_ray) ? context.light(connection.found)
                                                                       : vec3(0);
}
inline LaneVec3 light_over(LaneContext& context, const ConnectionOf<Lanes>& connection, const LaneMask& on) {
    const LaneMask asked = on && connection.exists;
    if (!any(asked)) return LaneVec3(0);
    return context.light(connection.found, context.visible(connection.shadow_ray, asked));
}

}  // namespace etendue
