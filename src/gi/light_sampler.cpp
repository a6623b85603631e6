#include "gi/light_sampler.h"

namespace etendue {

namespace {

// Of one emitter, so that sums stay numbers: what is brighter, or not a number of radiance at all, is still chosen.
constexpr float MOST_POWER = 1e30f;

}  // namespace

LightSampler::LightSampler(std::span<const Light> lights) : lights_(lights), first_(lights.size()) {
    std::vector<EmitterBounds> bounds;
    std::vector<double> powers;
    const auto add = [&](size_t i, uint32_t triangle, double power) {
        emitters_.push_back({&lights[i], triangle});
        powers.push_back(power);
    };
    for (size_t i = 0; i < lights.size(); ++i) {
        if (!lights[i].mesh()) continue;
        first_[i] = static_cast<uint32_t>(emitters_.size());
        for (uint32_t triangle = 0; triangle < lights[i].mesh()->triangles.size(); ++triangle) {
            bounds.push_back(lights[i].bounds(triangle));
            float& power = bounds.back().power;
            power = std::min(power, MOST_POWER);
            add(i, triangle, power);
        }
    }
    for (size_t i = 0; i < lights.size(); ++i) {
        if (lights[i].mesh()) continue;
        first_[i] = static_cast<uint32_t>(emitters_.size());
        add(i, 0, std::min(lights[i].power(), MOST_POWER));
    }
    by_power_ = Distribution1D(powers);
    if (bounds.size() < WORTH_A_TREE || by_power_.total() <= 0) return;
    tree_ = LightTree(bounds);
    others_ = Distribution1D(std::span(powers).subspan(bounds.size()));
    double of_triangles = 0;
    for (const EmitterBounds& emitter : bounds) of_triangles += emitter.power;
    triangles_share_ = of_triangles / by_power_.total();
}

std::optional<LightSampler::Choice> LightSampler::sample(Kind kind, const vec3& reference, double u,
                                                         const LightFactors* learned) const {
    if (by_power_.total() <= 0) return std::nullopt;
    if (kind == Kind::power || tree_.empty()) {
        const auto choice = by_power_.sample(u);
        const auto [light, triangle] = emitters_[choice.index];
        return Choice{light, triangle, choice.pmf, choice.remapped};
    }
    const double share = share_of_tree(learned);
    if (u < share) {
        const auto choice =
            tree_.sample(reference, std::min(u / share, 1 - 0x1p-52), learned ? &learned->tree : nullptr);
        if (!choice) return std::nullopt;
        const auto [light, triangle] = emitters_[choice->emitter];
        return Choice{light, triangle, static_cast<float>(share) * choice->pmf,
                      std::min(static_cast<float>(choice->remapped), ONE_MINUS_EPSILON)};
    }
    const auto choice = others_.sample(std::min((u - share) / (1 - share), 1 - 0x1p-53));
    const auto [light, triangle] = emitters_[by_power_.size() - others_.size() + choice.index];
    return Choice{light, triangle, static_cast<float>(1 - share) * choice.pmf, choice.remapped};
}

float LightSampler::pmf(Kind kind, const vec3& reference, const Light* light, uint32_t triangle,
                        const LightFactors* learned) const {
    if (by_power_.total() <= 0) return 0;
    const uint32_t index = emitter(light, triangle);
    if (kind == Kind::power || tree_.empty()) return by_power_.pmf(index);
    const double share = share_of_tree(learned);
    if (light->mesh())
        return static_cast<float>(share) * tree_.pmf(reference, index, learned ? &learned->tree : nullptr);
    if (!has_others()) return 0;
    return static_cast<float>(1 - share) *
           others_.pmf(index - static_cast<uint32_t>(by_power_.size() - others_.size()));
}

}  // namespace etendue
