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

LightSampler::Choice LightSampler::of_all(double u) const {
    const auto choice = by_power_.sample(u);
    const auto [light, triangle] = emitters_[choice.index];
    return {light, triangle, choice.pmf, choice.remapped};
}

LightSampler::Choice LightSampler::of_others(double u, double share) const {
    const auto choice = others_.sample(std::min((u - share) / (1 - share), 1 - 0x1p-53));
    const auto [light, triangle] = emitters_[by_power_.size() - others_.size() + choice.index];
    return {light, triangle, static_cast<float>(1 - share) * choice.pmf, choice.remapped};
}

LightSampler::Choice LightSampler::of_tree(const LightTree::Choice& choice, double share) const {
    const auto [light, triangle] = emitters_[choice.emitter];
    return {light, triangle, static_cast<float>(share) * choice.pmf,
            std::min(static_cast<float>(choice.remapped), ONE_MINUS_EPSILON)};
}

std::optional<LightSampler::Choice> LightSampler::sample(Kind kind, const vec3& reference, double u,
                                                         const LightFactors* learned) const {
    if (by_power_.total() <= 0) return std::nullopt;
    if (kind == Kind::power || tree_.empty()) return of_all(u);
    const double share = share_of_tree(learned);
    if (u >= share) return of_others(u, share);
    const auto choice = tree_.sample(reference, within(u, share), learned ? &learned->tree : nullptr);
    if (!choice) return std::nullopt;
    return of_tree(*choice, share);
}

PerLane<std::optional<LightSampler::Choice>> LightSampler::sample(
    Kind kind, const LaneMask& on, const LaneVec3& references, const PerLane<double>& u,
    const PerLane<const LightFactors*>& learned) const {
    PerLane<std::optional<Choice>> out;
    if (by_power_.total() <= 0) return out;
    if (kind == Kind::power || tree_.empty()) {
        for_lanes(on, [&](int i) { out[i] = of_all(u[i]); });
        return out;
    }
    PerLane<bool> by_tree{};
    PerLane<double> shares{}, remapped{};
    PerLane<const LightTree::Factors*> factors{};
    for_lanes(on, [&](int i) {
        shares[i] = share_of_tree(learned[i]);
        by_tree[i] = u[i] < shares[i];
        if (!by_tree[i]) {
            out[i] = of_others(u[i], shares[i]);
            return;
        }
        remapped[i] = within(u[i], shares[i]);
        factors[i] = learned[i] ? &learned[i]->tree : nullptr;
    });
    const auto choices = tree_.sample(mask_of(by_tree), references, remapped, factors);
    for (int i = 0; i < LANES; ++i) {
        if (const auto& choice = choices[i]) out[i] = of_tree(*choice, shares[i]);
    }
    return out;
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
