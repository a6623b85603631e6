#include "algorithms/light_guide.h"

#include <cmath>

#include "algorithms/direct_light.h"
#include "algorithms/russian_roulette.h"

namespace etendue {

namespace {

/// A light chosen by the tree at a vertex, and what it brought.
struct Trial {
    vec3 position, normal;
    bool of_triangles;                      // or of another light, as the sky
    std::optional<LightTree::Slots> slots;  // empty also where the tree led to nothing that could shine there
    float estimate;                         // luminance, over the probability of the choice
    float importance;                       // of all triangles together
};

/// Trials of one choice among n ways. In double, as squares of the brightest and of the dimmest light are no numbers in
/// single precision.
template <size_t n>
struct Ways {
    std::array<double, n> count{}, sum_squares{};

    void add(uint32_t way, double estimate) {
        count[way] += 1;
        sum_squares[way] += estimate * estimate;
    }

    /// The mean squares of the trials of each way, of which only the ratios count: as a trial's estimate is divided by
    /// the probability of its way, that is by its share in the importances, these say how much more comes than the
    /// importance promised. `prior` counts as much as a few trials of each way.
    std::array<double, n> mean_squares(const std::array<double, n>& prior) const {
        constexpr double PRIOR_TRIALS = 4;
        double found = 0, expected = 0;
        for (size_t i = 0; i < n; ++i) found += sum_squares[i], expected += count[i] * prior[i];
        // Where nothing was found at all, what was tried less often is the better guess.
        const double scale = found > 0 ? expected / found : 0;
        std::array<double, n> out;
        for (size_t i = 0; i < n; ++i) {
            out[i] = (sum_squares[i] * scale + PRIOR_TRIALS * prior[i]) / (count[i] + PRIOR_TRIALS);
        }
        return out;
    }
};

/// What a way keeps of its probability at least, relative to the most favoured one: light may come through a chink that
/// no trial has met.
constexpr double LEAST = 0.02;

/// Roots, relative to the largest.
template <size_t n>
std::array<float, n> relative_roots(const std::array<double, n>& squares) {
    const double most = *std::ranges::max_element(squares);
    std::array<float, n> out;
    for (size_t i = 0; i < n; ++i) out[i] = static_cast<float>(std::max(std::sqrt(squares[i] / most), LEAST));
    return out;
}

/// Of a cell: mean squares of the ways of its three choices.
struct CellSquares {
    static constexpr size_t WIDTH = LightTree::WIDTH;

    std::array<double, 2> groups;  // triangles, and other lights
    std::array<double, WIDTH> root;
    std::array<std::array<double, WIDTH>, WIDTH> below;

    /// Where nothing is known.
    static CellSquares even() {
        CellSquares all;
        all.groups.fill(1);
        all.root.fill(1);
        for (auto& slots : all.below) slots.fill(1);
        return all;
    }

    /// triangles_share: with which the trials were made.
    LightFactors factors(float triangles_share) const {
        LightFactors out;
        out.triangles_share = triangles_share;
        if (triangles_share < 1) {
            const double triangles = triangles_share * std::sqrt(groups[0]);
            const double others = (1 - triangles_share) * std::sqrt(groups[1]);
            out.triangles_share =
                static_cast<float>(std::clamp(triangles / (triangles + others), LEAST, 1 - LEAST));
        }
        out.tree.root = LightTree::SlotFactors(relative_roots(root));
        for (size_t i = 0; i < WIDTH; ++i)
            out.tree.below[i] = LightTree::SlotFactors(relative_roots(below[i]));
        return out;
    }
};

/// The trials of a cell.
struct CellTrials {
    Ways<2> groups;
    Ways<LightTree::WIDTH> root;
    std::array<Ways<LightTree::WIDTH>, LightTree::WIDTH> below;

    void add(const Trial& trial) {
        groups.add(trial.of_triangles ? 0 : 1, trial.estimate);
        if (!trial.slots) return;
        // Relative, so that it does not count for more where all lamps are near. Of a sky nothing is nearer.
        const double relative = double{trial.estimate} / trial.importance;
        root.add(trial.slots->root, relative);
        if (trial.slots->below) below[trial.slots->root].add(*trial.slots->below, relative);
    }

    CellSquares squares(const CellSquares& prior) const {
        CellSquares out;
        out.groups = groups.mean_squares(prior.groups);
        out.root = root.mean_squares(prior.root);
        for (size_t i = 0; i < below.size(); ++i) out.below[i] = below[i].mean_squares(prior.below[i]);
        return out;
    }
};

/// Makes trials along the beginnings of paths.
class Explorer {
  public:
    Explorer(const Preparation& preparation, int max_edges, Mis mis)
        : preparation_(preparation),
          max_edges_(max_edges),
          mis_(mis),
          roulette_(Parameters(RussianRoulette::parameters(), {})),
          // Other lights as often as triangles, so that a strong sky behind a roof does not keep all trials for itself.
          factors_(LightFactors::even(preparation.scene.light_sampler().has_others() ? 0.5f : 1.f)) {}

    float triangles_share() const { return factors_.triangles_share; }

    std::vector<Trial> trials(uint32_t first_path, uint32_t paths) const {
        // Beyond the seeds that a scene file may have, so that no estimate uses the same numbers.
        constexpr uint64_t SEED = 0x6c69676874677569;
        std::vector<Trial> all;
        Context context(preparation_.scene, Sampler(Sampler::Kind::sobol, SEED));
        const Camera& camera = preparation_.camera;
        for (uint32_t i = first_path; i < first_path + paths; ++i) {
            context.sampler.start(0, i);
            const vec2 film = context.sampler.next_2d() * vec2(camera.width(), camera.height());
            follow(context, camera.ray(film, context.sampler.next_2d()), all);
        }
        return all;
    }

  private:
    void follow(Context& context, Ray ray, std::vector<Trial>& trials) const {
        // Deeper down there is less light, and most of it in cells that are known by then.
        constexpr int MOST_VERTICES = 3;
        vec3 throughput(1);
        float eta_scale = 1;
        for (int depth = 1; depth < max_edges_ && depth <= MOST_VERTICES; ++depth) {
            context.sampler.start_vertex(depth);
            const SurfaceHit hit = context.intersect(ray);
            if (!hit.valid) return;
            if (!hit.is_type(BRDF_SPECULAR)) try_light(context, hit, trials);
            const BsdfSample bounce = context.bounce(hit);
            if (!bounce.exists) return;
            throughput *= bounce.weight;
            eta_scale *= bounce.eta2;
            if (is_black(throughput)) return;
            const float bounces = static_cast<float>(depth);
            if (!roulette_.survives(context, throughput, eta_scale, bounces, true)) return;
            ray = hit.ray_towards(bounce.wi);
        }
    }

    void try_light(Context& context, const SurfaceHit& hit, std::vector<Trial>& trials) const {
        const LightTree& tree = context.scene.light_sampler().tree();
        Trial trial{hit.point.position, hit.frame.n, true, std::nullopt, 0, 0};
        const auto [choice, across] = choose_light(context, hit, LightSampler::Kind::tree, &factors_);
        if (choice) {
            trial.estimate = luminance(light_over(context, connect(hit, *choice, across, vec3(1), 2, mis_)));
            if (!std::isfinite(trial.estimate)) return;
            trial.of_triangles = choice->light->mesh() != nullptr;
            if (trial.of_triangles) {
                trial.slots =
                    tree.slots(context.scene.light_sampler().emitter(choice->light, choice->triangle));
                trial.importance = tree.importance(hit.point.position);
            }
        }
        trials.push_back(trial);
    }

    const Preparation& preparation_;
    int max_edges_;
    Mis mis_;
    RussianRoulette roulette_;
    LightFactors factors_;
};

/// The longest side of the box of all trials but a few, which may be far out.
float extent(const std::vector<Trial>& trials, vec3& lower) {
    constexpr size_t OUT_OF = 50;
    const size_t few = trials.size() / OUT_OF;
    std::vector<float> along(trials.size());
    float longest = 0;
    for (int axis = 0; axis < 3; ++axis) {
        for (size_t i = 0; i < trials.size(); ++i) along[i] = trials[i].position[axis];
        std::ranges::nth_element(along, along.begin() + static_cast<ptrdiff_t>(few));
        lower[axis] = along[few];
        std::ranges::nth_element(along, along.end() - 1 - static_cast<ptrdiff_t>(few));
        longest = std::max(longest, along[along.size() - 1 - few] - lower[axis]);
    }
    return longest;
}

}  // namespace

bool LightGuide::learn(const Preparation& preparation, int max_edges, Mis mis) {
    if (preparation.scene.light_sampler().tree().empty()) return true;
    const Explorer explorer(preparation, max_edges, mis);
    constexpr float SMALL = 16, LARGE = 4;  // cells along the longest side of what the first round sees
    // In rounds, so that not all trials are kept at once.
    constexpr uint32_t PATHS_A_ROUND = FEWEST_PATHS, PATHS_AT_ONCE = 256;
    Cells small, large;
    std::vector<CellTrials> in_small, in_large;
    std::vector<uint32_t> around;  // the large cell of each small one
    for (uint32_t first = 0; first < paths(preparation.camera); first += PATHS_A_ROUND) {
        std::vector<std::vector<Trial>> parts(PATHS_A_ROUND / PATHS_AT_ONCE);
        const bool complete = preparation.for_each(parts.size(), [&](uint32_t part) {
            parts[part] = explorer.trials(first + part * PATHS_AT_ONCE, PATHS_AT_ONCE);
        });
        if (!complete) return false;
        // In the order of the paths, so that sums do not depend on threads.
        std::vector<Trial> trials;
        for (const auto& part : parts) trials.insert(trials.end(), part.begin(), part.end());
        if (trials.empty()) continue;
        if (around.empty()) {
            vec3 lower(0);
            const float side = std::clamp(extent(trials, lower), 1e-30f, 1e30f);
            small = Cells(lower, side / SMALL);
            large = Cells(lower, side / LARGE);
        }
        for (const Trial& trial : trials) {
            const uint32_t small_cell = small.find_or_add(trial.position, trial.normal);
            const uint32_t large_cell = large.find_or_add(trial.position, trial.normal);
            in_small.resize(small.count());
            in_large.resize(large.count());
            around.resize(small.count(), large_cell);
            in_small[small_cell].add(trial);
            in_large[large_cell].add(trial);
        }
    }
    std::vector<CellSquares> of_large;
    for (const CellTrials& cell : in_large) {
        of_large.push_back(cell.squares(CellSquares::even()));
        of_large_.push_back(of_large.back().factors(explorer.triangles_share()));
    }
    for (size_t i = 0; i < in_small.size(); ++i) {
        of_small_.push_back(in_small[i].squares(of_large[around[i]]).factors(explorer.triangles_share()));
    }
    small_ = std::move(small);
    large_ = std::move(large);
    return true;
}

const LightFactors* LightGuide::at(const vec3& position, const vec3& normal) const {
    if (of_small_.empty()) return nullptr;
    const uint32_t small = small_.find(position, normal);
    return small != Cells::NONE ? &of_small_[small] : in_large(position, normal);
}

PerLane<const LightFactors*> LightGuide::at(const LaneMask& on, const LaneVec3& positions,
                                            const LaneVec3& normals) const {
    PerLane<const LightFactors*> out{};
    if (of_small_.empty()) return out;
    PerLane<uint64_t> keys{};
    for_lanes(on, [&](int i) { keys[i] = small_.begin_find(positions.lane(i), normals.lane(i)); });
    for_lanes(on, [&](int i) {
        const uint32_t small = small_.find(keys[i]);
        out[i] = small != Cells::NONE ? &of_small_[small] : in_large(positions.lane(i), normals.lane(i));
        if (out[i]) prefetch(out[i]);
    });
    return out;
}

const LightFactors* LightGuide::in_large(const vec3& position, const vec3& normal) const {
    const uint32_t large = large_.find(position, normal);
    return large == Cells::NONE ? nullptr : &of_large_[large];
}

uint64_t LightGuide::Cells::begin_find(const vec3& position, const vec3& normal) const {
    const uint64_t key = key_of(position, normal);
    prefetch(&slots_[mix_bits(key) & (slots_.size() - 1)]);
    return key;
}

uint64_t LightGuide::Cells::key_of(const vec3& position, const vec3& normal) const {
    // In this order, no number at all is the farthest.
    constexpr float FARTHEST = 1 << 19;
    const auto along = [](float cells) {
        return static_cast<uint64_t>(std::max(std::min(FARTHEST - 1, std::floor(cells)), -FARTHEST) +
                                     FARTHEST);
    };
    const vec3 cells = (position - origin_) * per_length_;
    const vec3 size = glm::abs(normal);
    const int axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
    const uint64_t facing = 2 * axis + (normal[axis] < 0);
    return along(cells.x) | along(cells.y) << 20 | along(cells.z) << 40 | facing << 60;
}

size_t LightGuide::Cells::slot_of(uint64_t key) const {
    const size_t mask = slots_.size() - 1;
    size_t i = mix_bits(key) & mask;
    while (slots_[i].cell != NONE && slots_[i].key != key) i = (i + 1) & mask;
    return i;
}

uint32_t LightGuide::Cells::find(const vec3& position, const vec3& normal) const {
    return slots_[slot_of(key_of(position, normal))].cell;
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
