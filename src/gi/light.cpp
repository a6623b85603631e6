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

}  // namespace

std::vector<Light> Light::find_all(const LightContext& context) {
    std::vector<Light> lights;
    find_each(context, lights, static_cast<std::variant<ETENDUE_LIGHTS>*>(nullptr));
    return lights;
}

}  // namespace etendue
