#include "gi/light_tree.h"

#include <utility>

namespace etendue {

namespace {

// From this depth on parts are halved: a way of 16 steps, as many as fit its 64 bits, then leads to any of 2^31 emitters.
constexpr uint32_t DEEP = 8;

/// Whether a node has something to choose, of a brightness that numbers can tell.
bool may_choose(float total) { return total > 0 && total < INFINITE; }

/// A direction turned towards another by an angle; both unit.
vec3 turned(const vec3& from, const vec3& to, float angle) {
    const vec3 aside = to - glm::dot(to, from) * from;
    const float length = glm::length(aside);
    // Opposite directions: any way round will do.
    const vec3 tangent = length > 1e-6f ? aside / length : Frame(from).s;
    return std::cos(angle) * from + std::sin(angle) * tangent;
}

/// How much emitters are worth keeping apart: power, by the size of their bounds and of the solid angle that they
/// shine into (Conty Estevez and Kulla 2018, 4.1, the surface area orientation heuristic).
float cost(const EmitterBounds& bounds) {
    if (bounds.normals.is_empty()) return 0;
    const float o = bounds.normals.angle(), w = std::min(o + PI / 2, PI);
    const float solid_angle =
        2 * PI * (1 - std::cos(o)) +
        PI / 2 * (2 * w * std::sin(o) - std::cos(o - 2 * w) - 2 * o * std::sin(o) + std::cos(o));
    const vec3 size = bounds.upper - bounds.lower;
    return bounds.power * solid_angle * (size.x * size.y + size.y * size.z + size.z * size.x);
}

/// Some emitters, by their indices, and their bounds.
struct Part {
    std::span<uint32_t> indices;
    EmitterBounds bounds;

    Part(std::span<const EmitterBounds> emitters, std::span<uint32_t> indices) : indices(indices) {
        for (const uint32_t i : indices) bounds = bounds.united(emitters[i]);
    }
};

/// Cuts across the longest side of where the emitters are, at the place of least cost among a few, and returns how many
/// of the indices are then before it.
size_t cut(std::span<const EmitterBounds> emitters, std::span<uint32_t> indices, uint32_t depth) {
    constexpr int BUCKETS = 12;
    vec3 lower(INFINITE), upper(-INFINITE);
    for (const uint32_t i : indices) {
        lower = glm::min(lower, emitters[i].centre());
        upper = glm::max(upper, emitters[i].centre());
    }
    const vec3 size = upper - lower;
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    if (size[axis] <= 0 || depth >= DEEP) return indices.size() / 2;
    const auto bucket_of = [&](uint32_t i) {
        const float at = (emitters[i].centre()[axis] - lower[axis]) / size[axis];
        return std::min(static_cast<int>(at * BUCKETS), BUCKETS - 1);
    };
    std::array<EmitterBounds, BUCKETS> buckets;
    for (const uint32_t i : indices) {
        EmitterBounds& bucket = buckets[bucket_of(i)];
        bucket = bucket.united(emitters[i]);
    }
    // after[i]: all from bucket i on.
    std::array<EmitterBounds, BUCKETS> after = buckets;
    for (int i = BUCKETS - 2; i > 0; --i) after[i] = after[i].united(after[i + 1]);
    EmitterBounds before;
    float least = INFINITE;
    int best = 1;
    for (int end = 1; end < BUCKETS; ++end) {
        before = before.united(buckets[end - 1]);
        if (before.power == 0 || after[end].power == 0) continue;
        const float of_cut = cost(before) + cost(after[end]);
        if (of_cut < least) least = of_cut, best = end;
    }
    const auto middle =
        std::partition(indices.begin(), indices.end(), [&](uint32_t i) { return bucket_of(i) < best; });
    return static_cast<size_t>(middle - indices.begin());
}

}  // namespace

Cone Cone::united(const Cone& other) const {
    if (is_empty()) return other;
    if (other.is_empty()) return *this;
    const float a = angle(), b = other.angle();
    const float between = std::acos(std::clamp(glm::dot(axis, other.axis), -1.f, 1.f));
    if (std::min(between + b, PI) <= a) return *this;
    if (std::min(between + a, PI) <= b) return other;
    const float half = (a + between + b) / 2;
    if (half >= PI) return {axis, -1};
    return {turned(axis, other.axis, half - a), std::cos(half)};
}

EmitterBounds EmitterBounds::united(const EmitterBounds& other) const {
    return {glm::min(lower, other.lower), glm::max(upper, other.upper), normals.united(other.normals),
            power + other.power};
}

void LightTree::Node::set(uint32_t slot, const EmitterBounds& bounds) {
    const vec3 centre = bounds.centre();
    x[slot] = centre.x, y[slot] = centre.y, z[slot] = centre.z;
    // A little more than the bounds and the angles are, so that rounding never takes an emitter for unable to shine.
    radius[slot] = 1.001f * glm::length(bounds.upper - bounds.lower) / 2;
    axis_x[slot] = bounds.normals.axis.x, axis_y[slot] = bounds.normals.axis.y,
    axis_z[slot] = bounds.normals.axis.z;
    const float angle = std::min(bounds.normals.angle() + 1e-3f, PI);
    // Of pi the sine is rounded to below 0.
    cos_angle[slot] = std::cos(angle), sin_angle[slot] = std::max(std::sin(angle), 0.f);
    power[slot] = bounds.power;
}

LightTree::LightTree(std::span<const EmitterBounds> emitters) : ways_(emitters.size()) {
    std::vector<uint32_t> indices;
    for (uint32_t i = 0; i < emitters.size(); ++i) {
        if (emitters[i].power > 0) indices.push_back(i);
    }
    if (!indices.empty()) build(emitters, indices, 0, 0);
}

uint32_t LightTree::build(std::span<const EmitterBounds> emitters, std::span<uint32_t> indices, uint64_t path,
                          uint32_t depth) {
    std::vector<Part> parts;
    if (indices.size() <= WIDTH) {
        for (size_t i = 0; i < indices.size(); ++i) parts.emplace_back(emitters, indices.subspan(i, 1));
    } else {
        // The costliest part is cut again, until there are as many as a node holds. What fits into a node of its own
        // stays whole, or most nodes would be half empty. Deep down the largest one, so that the tree has an end.
        parts.emplace_back(emitters, indices);
        while (parts.size() < WIDTH) {
            const auto costliest = std::ranges::max_element(parts, {}, [&](const Part& part) {
                const size_t size = part.indices.size();
                return size <= WIDTH ? -1 : depth >= DEEP ? static_cast<float>(size) : cost(part.bounds);
            });
            if (costliest->indices.size() <= WIDTH) break;
            const std::span<uint32_t> whole = costliest->indices;
            const size_t before = cut(emitters, whole, depth);
            *costliest = {emitters, whole.first(before)};
            // Beside each other, so that emitters near each other are so in the order in which `u` chooses them, too: numbers
            // that are well spread then choose emitters that are.
            parts.emplace(costliest + 1, emitters, whole.subspan(before));
        }
    }
    const auto index = static_cast<uint32_t>(nodes_.size());
    nodes_.emplace_back();
    for (uint32_t slot = 0; slot < parts.size(); ++slot) {
        const uint64_t way = path | uint64_t{slot} << (BITS * depth);
        nodes_[index].set(slot, parts[slot].bounds);
        uint32_t child = 0;
        if (parts[slot].indices.size() == 1) {
            child = LEAF | parts[slot].indices[0];
            ways_[parts[slot].indices[0]] = {way, depth + 1};
        } else {
            child = build(emitters, parts[slot].indices, way, depth + 1);
        }
        nodes_[index].child[slot] = child;
    }
    return index;
}

LightTree::SlotFactors::SlotFactors(const std::array<float, WIDTH>& factors) {
    const float most = *std::ranges::max_element(factors);
    for (uint32_t i = 0; i < WIDTH; ++i) {
        const uint32_t below_one = ONE - std::bit_cast<uint32_t>(factors[i] / most);
        codes_[i] = static_cast<uint8_t>(std::min((below_one + (1u << (SHIFT - 1))) >> SHIFT, 255u));
    }
}

inline LightTree::Importances LightTree::importances(const Node& node, const vec3& reference) {
    Importances out;
    for (uint32_t i = 0; i < WIDTH; ++i) {
        const float x = reference.x - node.x[i], y = reference.y - node.y[i], z = reference.z - node.z[i];
        const float radius = node.radius[i], cos_cone = node.cos_angle[i], sin_cone = node.sin_angle[i];
        const float distance2 = x * x + y * y + z * z;
        const float outside = distance2 - radius * radius;
        // All sines and cosines but the cone's are times the distance, which saves its root and the divisions by it.
        const float cos_axis = node.axis_x[i] * x + node.axis_y[i] * y + node.axis_z[i] * z;
        const float sin_axis = safe_sqrt(distance2 - cos_axis * cos_axis);
        const float inverse2 =
            1 / std::max(distance2, std::max(radius * radius, std::numeric_limits<float>::min()));
        // Half the angle under which the bounding sphere is seen, and with the cone's beside it: as far may a normal
        // turn towards the reference, and the emitter move within the sphere.
        const float cos_sphere = safe_sqrt(outside);
        const float cos_both = cos_cone * cos_sphere - sin_cone * radius;
        const float sin_both = sin_cone * cos_sphere + cos_cone * radius;
        // Where both are more than half a turn, too, which is as far as an axis can be turned away.
        const bool may_face = (outside <= 0) | (sin_both <= 0) | (cos_axis >= cos_both);
        const float cos_rest = std::max((cos_axis * cos_both + sin_axis * sin_both) * inverse2, 0.f);
        out[i] = node.power[i] * inverse2 * (may_face ? 1 : cos_rest);
    }
    return out;
}

inline LightTree::Sums LightTree::sums_before(const Importances& importance) {
    Sums before;
    // First in fours, beside each other, as a sum waits for the one before.
    before[0] = 0;
    for (uint32_t four = 0; four < WIDTH; four += 4) {
        before[four + 1] = importance[four];
        for (uint32_t i = four + 1; i < four + 4; ++i) before[i + 1] = before[i] + importance[i];
    }
    for (uint32_t four = 4; four < WIDTH; four += 4) {
        const double sum = before[four];
        for (uint32_t i = four; i < four + 4; ++i) before[i + 1] += sum;
    }
    return before;
}

inline LightTree::Importances LightTree::importances(const Node& node, const vec3& reference,
                                                     const Factors* factors, uint32_t depth,
                                                     uint32_t root_slot) {
    Importances out = importances(node, reference);
    if (!factors || depth > 1) return out;
    const auto& known = depth == 0 ? factors->root : factors->below[root_slot];
    for (uint32_t i = 0; i < WIDTH; ++i) out[i] *= known[i];
    return out;
}

inline void LightTree::step(Descent& descent, const vec3& reference, const Factors* factors) const {
    const Node& node = nodes_[descent.node];
    const Importances importance = importances(node, reference, factors, descent.depth, descent.root_slot);
    const Sums before = sums_before(importance);
    const auto total = static_cast<float>(before[WIDTH]);
    descent.ended = !may_choose(total);
    if (descent.ended) return;
    // Below the last sum, as u is at most 1 - 2^-52: what is chosen has an importance.
    const double target = descent.u * before[WIDTH];
    uint32_t chosen = 0;
    // Without a branch, which would be guessed wrong every other time.
    for (uint32_t slot = 1; slot < WIDTH; ++slot) chosen += before[slot] <= target;
    descent.pmf *= importance[chosen] / total;
    descent.u = std::min((target - before[chosen]) / importance[chosen], 1 - 0x1p-52);
    if (descent.depth++ == 0) descent.root_slot = chosen;
    const uint32_t child = node.child[chosen];
    if (child & LEAF)
        descent.emitter = child & ~LEAF;
    else
        descent.node = child;
}

std::optional<LightTree::Choice> LightTree::sample(const vec3& reference, double u,
                                                   const Factors* factors) const {
    if (nodes_.empty()) return std::nullopt;
    Descent descent;
    descent.u = u;
    while (!descent.emitter) {
        step(descent, reference, factors);
        if (descent.ended) return std::nullopt;
    }
    return Choice{*descent.emitter, descent.pmf, descent.u};
}

PerLane<std::optional<LightTree::Choice>> LightTree::sample(const LaneMask& on, const LaneVec3& references,
                                                            const PerLane<double>& u,
                                                            const PerLane<const Factors*>& factors) const {
    PerLane<std::optional<Choice>> out;
    if (nodes_.empty()) return out;
    PerLane<Descent> descents;
    PerLane<int> under_way;
    int count = 0;
    for_lanes(on, [&](int i) {
        descents[i].u = u[i];
        under_way[count++] = i;
    });
    while (count > 0) {
        const int before = std::exchange(count, 0);
        for (int k = 0; k < before; ++k) {
            const int i = under_way[k];
            Descent& descent = descents[i];
            step(descent, references.lane(i), factors[i]);
            if (descent.ended) continue;
            if (descent.emitter) {
                out[i] = {*descent.emitter, descent.pmf, descent.u};
            } else {
                prefetch_lines(&nodes_[descent.node], sizeof(Node));
                under_way[count++] = i;
            }
        }
    }
    return out;
}

float LightTree::pmf(const vec3& reference, uint32_t emitter, const Factors* factors) const {
    const auto [slots, length] = ways_[emitter];
    float pmf = length > 0 ? 1 : 0;
    uint32_t index = 0;
    for (uint32_t depth = 0; depth < length; ++depth) {
        const Node& node = nodes_[index];
        const Importances importance = importances(node, reference, factors, depth, slots & (WIDTH - 1));
        const auto total = static_cast<float>(sums_before(importance)[WIDTH]);
        if (!may_choose(total)) return 0;
        const uint32_t slot = slots >> (BITS * depth) & (WIDTH - 1);
        pmf *= importance[slot] / total;
        index = node.child[slot];
    }
    return pmf;
}

LightTree::Slots LightTree::slots(uint32_t emitter) const {
    const auto [slots, length] = ways_[emitter];
    if (length == 1) return {static_cast<uint32_t>(slots), std::nullopt};
    return {static_cast<uint32_t>(slots & (WIDTH - 1)), static_cast<uint32_t>(slots >> BITS & (WIDTH - 1))};
}

float LightTree::importance(const vec3& reference) const {
    return nodes_.empty() ? 0 : static_cast<float>(sums_before(importances(nodes_[0], reference))[WIDTH]);
}

}  // namespace etendue
