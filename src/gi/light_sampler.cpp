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
    double of_triangles = 0;
    for (const EmitterBounds& emitter : bounds) of_triangles += emitter.power;
    triangles_share_ = of_triangles / by_power_.total();
}

std::optional<LightSampler::Choice> LightSampler::sample(Kind kind, const vec3& reference, double u,
                                                         const LightFactors* learned) const {
    if (by_power_.total() <= 0) return std::nullopt;
    float pmf = 1;
    if (kind == Kind::tree && triangles_share_ > 0) {
        const double share = learned ? learned->triangles_share : triangles_share_;
        if (u < share) {
            const auto choice =
                tree_.sample(reference, std::min(u / share, 1 - 0x1p-52), learned ? &learned->tree : nullptr);
            if (!choice) return std::nullopt;
            const auto [light, triangle] = emitters_[choice->emitter];
            return Choice{light, triangle, static_cast<float>(share) * choice->pmf,
                          std::min(static_cast<float>(choice->remapped), ONE_MINUS_EPSILON)};
        }
        // Among the others by power: they come last.
        const double stretch = (1 - triangles_share_) / (1 - share);
        pmf = static_cast<float>(1 / stretch);
        u = std::clamp(triangles_share_ + (u - share) * stretch, triangles_share_, 1 - 0x1p-53);
    }
    const auto choice = by_power_.sample(u);
    const auto [light, triangle] = emitters_[choice.index];
    return Choice{light, triangle, pmf * choice.pmf, choice.remapped};
}

float LightSampler::pmf(Kind kind, const vec3& reference, const Light* light, uint32_t triangle,
                        const LightFactors* learned) const {
    if (by_power_.total() <= 0) return 0;
    const uint32_t index = emitter(light, triangle);
    if (kind == Kind::power || triangles_share_ == 0) return by_power_.pmf(index);
    const double share = learned ? learned->triangles_share : triangles_share_;
    if (!light->mesh())
        return static_cast<float>((1 - share) / (1 - triangles_share_)) * by_power_.pmf(index);
    return static_cast<float>(share) * tree_.pmf(reference, index, learned ? &learned->tree : nullptr);
}

}  // namespace etendue
