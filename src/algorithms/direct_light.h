// Next event estimation at one vertex: light sampled on purpose, and the weight that it shares with light
// found by chance.
#pragma once

#include "algorithms/algorithm.h"
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
        return guide_.learn(preparation, max_edges, mis);
    }

    LightSampler::Kind kind() const { return kind_; }
    /// What is known of the region of a vertex; null: no more than what the scene itself knows.
    const LightFactors* learned(const SurfaceHit& hit) const {
        return guide_.at(hit.point.position, hit.frame.n);
    }

  private:
    LightSampler::Kind kind_;
    bool learns_;
    LightGuide guide_;
};

/// Weight of light sampling for a light sample: 1 without MIS.
inline float light_sampling_weight(Mis mis, float light_pdf, float bsdf_pdf) {
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
inline float bsdf_sampling_weight(Mis mis, float bsdf_pdf, float light_pdf) {
    switch (mis) {
        case Mis::power:
            return power_heuristic(bsdf_pdf, light_pdf);
        case Mis::balance:
            return balance_heuristic(bsdf_pdf, light_pdf);
        case Mis::none:
            return light_pdf > 0 ? 0 : 1;
    }
    return 1;
}

/// A light chosen for a vertex, if there was one to choose, and the number that is left for a place on it.
struct ChosenLight {
    std::optional<LightSampler::Choice> choice;
    float across;
};

inline ChosenLight choose_light(Context& context, const SurfaceHit& hit, LightSampler::Kind kind,
                                const LightFactors* learned) {
    const double finer_digits = context.sampler.next_1d();
    const vec2 u = context.sampler.next_2d();
    // One number chooses the light and the place along it, so that samples which are stratified over [0, 1) are so over
    // each light too. What of its digits the choice uses up, others make up for.
    return {
        context.scene.sample_light_source(kind, hit.point.position, u.x + finer_digits * 0x1p-24, learned),
        u.y};
}

/// Light that arrives at a vertex if nothing is between: the question, and what is found then.
struct Connection {
    bool exists = false;
    Ray shadow_ray;
    Contribution found;
};

/// To a place on a chosen light, at the end of a path of `edges` rays with the throughput of its vertex.
inline Connection connect(const SurfaceHit& hit, const LightSampler::Choice& choice, float across,
                          const vec3& throughput, int edges, Mis mis) {
    Connection connection;
    const auto sample = choice.light->sample_Li(hit.point.position, choice.triangle,
                                                {choice.remapped, across}, mis != Mis::none);
    if (!sample) return connection;
    const vec3 reflected = hit.f(sample->wi) * std::abs(glm::dot(sample->wi, hit.frame.n)) * sample->radiance;
    if (is_black(reflected)) return connection;
    connection.exists = true;
    connection.shadow_ray = shadow_ray(hit, *sample);
    Contribution& found = connection.found;
    found.technique = Technique::light_sampling;
    found.edges = edges;
    found.pdf = choice.pmf * sample->pdf;
    found.other_pdf = hit.pdf(sample->wi);
    found.weight = light_sampling_weight(mis, found.pdf, found.other_pdf);
    found.unweighted = throughput * reflected / found.pdf;
    return connection;
}

/// The same, to a light that is chosen first. None at delta surfaces, where a sampled light could never be seen.
inline Connection connect_to_light(Context& context, const SurfaceHit& hit, const vec3& throughput, int edges,
                                   LightSampler::Kind kind, const LightFactors* learned, Mis mis) {
    if (hit.is_type(BRDF_SPECULAR)) return {};
    const auto [choice, across] = choose_light(context, hit, kind, learned);
    return choice ? connect(hit, *choice, across, throughput, edges, mis) : Connection();
}

/// What arrives over a connection, for which its shadow ray is traced.
inline vec3 light_over(Context& context, const Connection& connection) {
    return connection.exists && context.visible(connection.shadow_ray) ? context.light(connection.found)
                                                                       : vec3(0);
}

}  // namespace etendue
