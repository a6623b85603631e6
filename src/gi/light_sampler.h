// Which light to sample: chosen by power.
#pragma once

#include "gi/distribution.h"
#include "gi/light.h"

namespace etendue {

class LightSampler {
  public:
    struct Choice {
        const Light* light;
        float pmf;
        float remapped;  // `u`, uniform in [0, 1) again
    };

    LightSampler() = default;
    explicit LightSampler(std::span<const Light> lights) : lights_(lights) {
        std::vector<double> powers;
        for (const Light& light : lights) powers.push_back(light.power());
        by_power_ = Distribution1D(powers);
    }

    /// Empty in a scene without light.
    std::optional<Choice> sample(float u) const {
        if (by_power_.total() <= 0) return std::nullopt;
        const auto choice = by_power_.sample(u);
        return Choice{&lights_[choice.index], choice.pmf, choice.remapped};
    }

    float pmf(const Light* light) const {
        return by_power_.pmf(static_cast<uint32_t>(light - lights_.data()));
    }

  private:
    std::span<const Light> lights_;
    Distribution1D by_power_;
};

}  // namespace etendue
