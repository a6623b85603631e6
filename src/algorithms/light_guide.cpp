#include "algorithms/light_guide.h"

#include <cmath>

#include "algorithms/direct_light.h"

namespace etendue {

namespace {

/// A vertex of a path, the light that was chosen there by the tree, and what it brought.
struct Sample {
    vec3 position, normal;
    std::optional<LightTree::Slots> slots;  // empty: another light than a triangle, the sky
    float estimate;                         // luminance, over the probability of the choice
    float available;                        // what the tree took for arriving from all triangles together
};

/// Samples of one choice among n ways, each with an importance. In double, as squares of the brightest and of the
/// dimmest light are no numbers in single precision.
template <size_t n>
struct Choices {
    std::array<double, n> count{}, sum_squares{};

    void add(uint32_t way, double estimate) {
        count[way] += 1;
        sum_squares[way] += estimate * estimate;
    }

    /// The mean squares of the ways, relative to each other, by these samples and by `prior`, which counts as much as
    /// PRIOR_SAMPLES of each. An estimate over the probability of its way, which is the way's share in the
    /// importances, is a multiple of contribution / importance: that is what factors on importances have to make up
    /// for.
    std::array<double, n> mean_squares(const std::array<double, n>& prior) const {
        constexpr double PRIOR_SAMPLES = 4;
        double found = 0, expected = 0;
        for (size_t i = 0; i < n; ++i) found += sum_squares[i], expected += count[i] * prior[i];
        // Where nothing was found at all, what was tried less often is the better guess.
        const double scale = found > 0 ? expected / found : 0;
        std::array<double, n> out;
        for (size_t i = 0; i < n; ++i) {
            out[i] = (sum_squares[i] * scale + PRIOR_SAMPLES * prior[i]) / (count[i] + PRIOR_SAMPLES);
        }
        return out;
    }
};

template <size_t n>
std::array<float, n> roots(const std::array<double, n>& values) {
    std::array<float, n> out;
    for (size_t i = 0; i < n; ++i) out[i] = static_cast<float>(std::sqrt(values[i]));
    return out;
}

/// Mean squares of what a cell's lights bring, relative to the importances that they have without it.
struct Knowledge {
    static constexpr size_t WIDTH = LightTree::WIDTH;

    std::array<double, 2> groups;  // triangles, and other lights
    std::array<double, WIDTH> root;
    std::array<std::array<double, WIDTH>, WIDTH> below;

    static Knowledge nothing() {
        Knowledge all;
        all.groups.fill(1);
        all.root.fill(1);
        for (auto& slots : all.below) slots.fill(1);
        return all;
    }

    /// On top of those that the samples were chosen with.
    LightFactors factors(float triangles_share) const {
        LightFactors out;
        const double triangles = triangles_share * std::sqrt(groups[0]);
        const double others = (1 - triangles_share) * std::sqrt(groups[1]);
        out.triangles_share = static_cast<float>(triangles / (triangles + others));
        out.tree.root = roots(root);
        for (size_t i = 0; i < WIDTH; ++i) out.tree.below[i] = roots(below[i]);
        return out;
    }
};

/// The samples of a cell.
struct CellSamples {
    Choices<2> groups;
    Choices<LightTree::WIDTH> root;
    std::array<Choices<LightTree::WIDTH>, LightTree::WIDTH> below;

    void add(const Sample& sample) {
        groups.add(sample.slots ? 0 : 1, sample.estimate);
        if (!sample.slots || !(sample.available > 0)) return;
        const double relative = double{sample.estimate} / sample.available;
        root.add(sample.slots->root, relative);
        if (sample.slots->below) below[sample.slots->root].add(*sample.slots->below, relative);
    }

    Knowledge knowledge(const Knowledge& prior) const {
        Knowledge out;
        out.groups = groups.mean_squares(prior.groups);
        out.root = root.mean_squares(prior.root);
        for (size_t i = 0; i < below.size(); ++i) out.below[i] = below[i].mean_squares(prior.below[i]);
        return out;
    }
};

/// How lights are chosen while nothing is known: by the tree alone, but the others as often as the triangles, so that
/// a strong sky behind a roof does not keep all samples for itself.
LightFactors unlearned(const Scene& scene) {
    const bool has_others = scene.light_sampler().triangles_share() < 1;
    return Knowledge::nothing().factors(has_others ? 0.5f : 1.f);
}

/// What light sampling with MIS brings at one vertex.
void sample_at(Context& context, const SurfaceHit& hit, const LightFactors& factors,
               std::vector<Sample>& samples) {
    const auto chosen = choose_light(context, hit, LightSampler::Kind::tree, &factors);
    if (!chosen) return;
    const LightSampler& sampler = context.scene.light_sampler();
    Sample sample{hit.point.position, hit.frame.n, std::nullopt, 0, 0};
    sample.estimate = luminance(light_from(context, hit, *chosen, vec3(1), 2, Mis::power));
    if (!std::isfinite(sample.estimate)) return;
    if (chosen->choice.light->mesh()) {
        sample.slots = sampler.tree().slots(sampler.emitter(chosen->choice.light, chosen->choice.triangle));
        sample.available = sampler.tree().importance(hit.point.position);
    }
    samples.push_back(sample);
}

void sample_along(Context& context, Ray ray, int max_edges, const LightFactors& factors,
                  std::vector<Sample>& samples) {
    // Deeper down there is less light, and most of it in cells that are known by then.
    constexpr int MOST_VERTICES = 3;
    vec3 throughput(1);
    for (int depth = 1; depth < max_edges && depth <= MOST_VERTICES; ++depth) {
        context.sampler.start_vertex(depth);
        const SurfaceHit hit = context.intersect(ray);
        if (!hit.valid) return;
        if (!hit.is_type(BRDF_SPECULAR)) sample_at(context, hit, factors, samples);
        const auto bounce = context.bounce(hit);
        if (!bounce) return;
        throughput *= bounce->weight;
        // As a render's own roulette by default, so that vertices are where a render has them.
        constexpr float THRESHOLD = 0.25f;
        const float survival = std::min(max_component(throughput) / THRESHOLD, 1.f);
        if (survival <= 0 || !context.roulette(1 - survival)) return;
        throughput /= survival;
        ray = hit.ray_towards(bounce->wi);
    }
}

/// The longest side of the box of all samples but a few, which may be far out.
float extent(const std::vector<Sample>& samples, vec3& lower) {
    constexpr size_t OUT_OF = 50;
    const size_t few = samples.size() / OUT_OF;
    std::vector<float> along(samples.size());
    float longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (size_t i = 0; i < samples.size(); ++i) along[i] = samples[i].position[axis];
        std::ranges::nth_element(along, along.begin() + static_cast<ptrdiff_t>(few));
        lower[axis] = along[few];
        std::ranges::nth_element(along, along.end() - 1 - static_cast<ptrdiff_t>(few));
        longest = std::max(longest, along[along.size() - 1 - few] - lower[axis]);
    }
    return longest;
}

}  // namespace

bool LightGuide::learn(const Preparation& preparation, int max_edges) {
    const Scene& scene = preparation.scene;
    if (scene.light_sampler().tree().empty()) return true;
    constexpr uint32_t PATHS_AT_ONCE = 256;
    std::vector<std::vector<Sample>> parts(PATHS / PATHS_AT_ONCE);
    const LightFactors before = unlearned(scene);
    const bool complete = preparation.for_each(parts.size(), [&](uint32_t part) {
        // Numbers of their own: of a seed that no render has by any other chance than any other.
        constexpr uint64_t SEED = 0x6c69676874677569;
        Context context(scene, Sampler(Sampler::Kind::sobol, SEED));
        for (uint32_t i = part * PATHS_AT_ONCE; i < (part + 1) * PATHS_AT_ONCE; ++i) {
            context.sampler.start(0, i);
            const vec2 film =
                context.sampler.next_2d() * vec2(preparation.camera.width(), preparation.camera.height());
            sample_along(context, preparation.camera.ray(film, context.sampler.next_2d()), max_edges, before,
                         parts[part]);
        }
    });
    if (!complete) return false;
    // In the order of the paths, so that sums do not depend on threads.
    std::vector<Sample> samples;
    for (const auto& part : parts) samples.insert(samples.end(), part.begin(), part.end());
    if (samples.empty()) return true;

    constexpr float SMALL = 16, LARGE = 4;  // cells along the longest side of what was seen
    vec3 lower(0);
    const float side = std::max(extent(samples, lower), std::numeric_limits<float>::min());
    small_ = Cells(lower, side / SMALL);
    large_ = Cells(lower, side / LARGE);
    std::vector<CellSamples> in_small, in_large;
    std::vector<uint32_t> around;  // the large cell of each small one
    for (const Sample& sample : samples) {
        const uint32_t small = small_.find_or_add(sample.position, sample.normal);
        const uint32_t large = large_.find_or_add(sample.position, sample.normal);
        in_small.resize(small_.count());
        in_large.resize(large_.count());
        around.resize(small_.count(), large);
        in_small[small].add(sample);
        in_large[large].add(sample);
    }
    std::vector<Knowledge> of_large;
    of_large_.clear();
    of_small_.clear();
    for (const CellSamples& cell : in_large) {
        of_large.push_back(cell.knowledge(Knowledge::nothing()));
        of_large_.push_back(of_large.back().factors(before.triangles_share));
    }
    for (size_t i = 0; i < in_small.size(); ++i) {
        of_small_.push_back(in_small[i].knowledge(of_large[around[i]]).factors(before.triangles_share));
    }
    return true;
}

const LightFactors* LightGuide::at(const vec3& position, const vec3& normal) const {
    if (of_small_.empty()) return nullptr;
    const uint32_t small = small_.find(position, normal);
    if (small != Cells::NONE) return &of_small_[small];
    const uint32_t large = large_.find(position, normal);
    return large == Cells::NONE ? nullptr : &of_large_[large];
}

uint64_t LightGuide::Cells::key_of(const vec3& position, const vec3& normal) const {
    constexpr float FARTHEST = 1 << 19;
    const vec3 cell =
        glm::clamp(glm::floor((position - origin_) * per_length_), -FARTHEST, FARTHEST - 1) + FARTHEST;
    const vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint64_t facing = 2 * axis + (normal[axis] < 0);
    return static_cast<uint64_t>(cell.x) | static_cast<uint64_t>(cell.y) << 20 |
           static_cast<uint64_t>(cell.z) << 40 | facing << 60;
}

size_t LightGuide::Cells::slot_of(uint64_t key) const {
    const size_t mask = slots_.size() - 1;
    size_t i = mix_bits(key) & mask;
    while (slots_[i].cell != NONE && slots_[i].key != key) i = (i + 1) & mask;
    return i;
}

uint32_t LightGuide::Cells::find(const vec3& position, const vec3& normal) const {
    return slots_.empty() ? NONE : slots_[slot_of(key_of(position, normal))].cell;
}

uint32_t LightGuide::Cells::find_or_add(const vec3& position, const vec3& normal) {
    if (size_t{2} * (count_ + 1) > slots_.size()) {
        std::vector<Slot> old(std::max<size_t>(2 * slots_.size(), 64));
        std::swap(old, slots_);
        for (const Slot& slot : old) {
            if (slot.cell != NONE) slots_[slot_of(slot.key)] = slot;
        }
    }
    const uint64_t key = key_of(position, normal);
    Slot& slot = slots_[slot_of(key)];
    if (slot.cell == NONE) slot = {key, count_++};
    return slot.cell;
}

}  // namespace etendue
