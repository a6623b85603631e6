#include "algorithms/algorithm.h"

#include <stdexcept>

namespace etendue {

namespace {

// A function's static, as the registrations of other files may run before this file's globals exist.
std::map<std::string, AlgorithmInfo>& registry() {
    static std::map<std::string, AlgorithmInfo> all;
    return all;
}

/// The given value as the type of the default; a whole number may stand for a real one.
ParameterValue converted(const Parameter& declared, ParameterValue given) {
    if (std::holds_alternative<double>(declared.default_value) && std::holds_alternative<int>(given)) {
        given = static_cast<double>(std::get<int>(given));
    }
    if (given.index() != declared.default_value.index()) {
        throw std::invalid_argument(declared.name + ": a value of another type than its default");
    }
    if (const auto* text = std::get_if<std::string>(&given)) {
        if (std::ranges::find(declared.choices, *text) == declared.choices.end()) {
            throw std::invalid_argument(declared.name + ": there is no choice \"" + *text + "\"");
        }
    } else if (!std::holds_alternative<bool>(given)) {
        const double number =
            std::holds_alternative<int>(given) ? std::get<int>(given) : std::get<double>(given);
        if (!(number >= declared.minimum && number <= declared.maximum)) {
            throw std::invalid_argument(declared.name + ": out of range");
        }
    }
    return given;
}

}  // namespace

Parameters::Parameters(const std::vector<Parameter>& declared,
                       const std::map<std::string, ParameterValue>& given) {
    for (const Parameter& p : declared) {
        const auto it = given.find(p.name);
        values_[p.name] = it == given.end() ? p.default_value : converted(p, it->second);
    }
    for (const auto& [name, value] : given) {
        if (!values_.contains(name))
            throw std::invalid_argument("the algorithm has no parameter \"" + name + "\"");
    }
}

const std::map<std::string, AlgorithmInfo>& algorithms() { return registry(); }

void register_algorithm(AlgorithmInfo info) {
    const std::string name = info.name;
    registry()[name] = std::move(info);
}

std::unique_ptr<Algorithm> make_algorithm(const std::string& name,
                                          const std::map<std::string, ParameterValue>& given) {
    const auto it = algorithms().find(name);
    if (it == algorithms().end()) throw std::invalid_argument("there is no algorithm \"" + name + "\"");
    return it->second.make(Parameters(it->second.parameters, given));
}

uint64_t PathByPath::estimate(const Scene& scene, SampleQueue& queue) const {
    uint64_t rays = 0;
    for (size_t i = 0;; ++i) {
        const auto sample = queue.next();
        if (!sample) return rays;
        Context context(scene, Sampler(sample->numbers), sample->observer);
        queue.estimated(i, radiance(context, sample->ray));
        rays += context.rays;
    }
}

Parameter max_path_length_parameter() {
    return {"max_cam_path_length", "longest path, in edges", 10, 1, 1'000'000, {}};
}

}  // namespace etendue
