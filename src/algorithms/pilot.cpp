#include "algorithms/pilot.h"

#include <numeric>

namespace etendue {

namespace {

// Random numbers that no render uses.
constexpr uint64_t SEED = 0xf11e7ca3b0a7ull;
// The variance is that of two blocks of Sobol's sequence, so what stratification does to it is in it.
constexpr uint32_t GROUPS_ACROSS = 5, GROUPS = GROUPS_ACROSS * GROUPS_ACROSS, PIXELS = 8, BLOCKS = 2,
                   SAMPLES = 16;
constexpr uint32_t TILE = 16;  // side of the square that the pixels of a group are in
// The largest variances, which may be those of rare bright samples, are left out: one in so many.
constexpr uint32_t LEFT_OUT = 20;
// Of the square of the image's mean: what is added to a pixel's, so that the darkest do not decide.
constexpr float EPSILON = 0.01f;
// Measured on the bundled scenes: the time of sharing at all, and of one more ray over that of those of a path.
constexpr float OVERHEAD = 0.06f, RAY = 0.8f;

/// The samples of a group of pixels, block after block.
class GroupQueue : public SampleQueue {
  public:
    GroupQueue(const Camera& camera, uint32_t group) : camera_(camera) {
        const auto tile = [](uint32_t at, uint32_t size) {
            return static_cast<uint32_t>((static_cast<float>(at) + 0.5f) / GROUPS_ACROSS *
                                         static_cast<float>(size)) /
                   TILE * TILE;
        };
        const uint32_t x = tile(group % GROUPS_ACROSS, camera.width()),
                       y = tile(group / GROUPS_ACROSS, camera.height());
        for (uint32_t i = 0; i < PIXELS; ++i) {
            const uint64_t bits = mix_bits(SEED + uint64_t{group} * PIXELS + i);
            xs_[i] = std::min(x + static_cast<uint32_t>(bits % TILE), camera.width() - 1);
            ys_[i] = std::min(y + static_cast<uint32_t>((bits >> 32) % TILE), camera.height() - 1);
        }
    }

    std::optional<CameraSample> next() override {
        if (given_ == BLOCKS * SAMPLES * PIXELS) return std::nullopt;
        const uint32_t pixel = given_ % PIXELS, sample = given_ / PIXELS;
        ++given_;
        Sampler numbers(Sampler::Kind::sobol, SEED + sample / SAMPLES);
        const auto stream = numbers.stream(ys_[pixel] << 16 | xs_[pixel], sample % SAMPLES);
        numbers.start(stream);
        const vec2 place = vec2(xs_[pixel], ys_[pixel]) + numbers.next_2d();
        return CameraSample{camera_.ray(place, numbers.next_2d()), stream, nullptr, pixel > 0};
    }
    void estimated(size_t, const vec3&) override {}

  private:
    const Camera& camera_;
    std::array<uint32_t, PIXELS> xs_, ys_;
    uint32_t given_ = 0;
};

/// Of one pixel: the means of its blocks.
struct PixelMeans {
    std::array<vec3, BLOCKS> alone{}, shared{};
    vec3 mean() const { return 0.5f * (alone[0] + alone[1]); }
};

std::vector<PixelMeans> means_of(const ReuseTrial& trial) {
    std::vector<PixelMeans> means(PIXELS);
    for (size_t i = 0; i < trial.estimates.size(); ++i) {
        PixelMeans& pixel = means[i % PIXELS];
        const size_t block = i / PIXELS / SAMPLES;
        pixel.alone[block] += trial.estimates[i].alone / float{SAMPLES};
        pixel.shared[block] += trial.estimates[i].shared / float{SAMPLES};
    }
    return means;
}

/// Sums of the relative variances of all pixels.
struct Variances {
    float alone = 0, shared = 0;
};
Variances variances_of(const std::vector<PixelMeans>& pixels, const vec3& mean) {
    std::vector<float> alone, shared;
    for (const PixelMeans& pixel : pixels) {
        const vec3 scale = pixel.mean() * pixel.mean() + EPSILON * mean * mean + 1e-30f;
        const auto relative = [&](const vec3& difference) {
            return dot(difference * difference / scale, vec3(1));
        };
        alone.push_back(relative(pixel.alone[0] - pixel.alone[1]));
        shared.push_back(relative(pixel.shared[0] - pixel.shared[1]));
    }
    const auto trimmed_sum = [](std::vector<float>& all) {
        std::ranges::sort(all);
        return std::accumulate(all.begin(), all.end() - static_cast<ptrdiff_t>(all.size() / LEFT_OUT), 0.f);
    };
    return {trimmed_sum(alone), trimmed_sum(shared)};
}

}  // namespace

std::optional<Pilot> fly(const Preparation& preparation, bool may_share, const TryReuse& try_reuse) {
    std::vector<ReuseTrial> trials(GROUPS);
    const bool complete = preparation.for_each(GROUPS, [&](uint32_t group) {
        GroupQueue queue(preparation.camera, group);
        trials[group] = try_reuse(queue);
    });
    if (!complete) return std::nullopt;
    std::vector<PixelMeans> pixels;
    float rays = 1, rays_of_sharing = 0;
    for (const ReuseTrial& trial : trials) {
        const std::vector<PixelMeans> means = means_of(trial);
        pixels.insert(pixels.end(), means.begin(), means.end());
        rays += static_cast<float>(trial.rays);
        rays_of_sharing += static_cast<float>(trial.rays_of_sharing);
    }
    vec3 mean(0);
    for (const PixelMeans& pixel : pixels) mean += pixel.mean() / static_cast<float>(pixels.size());
    const Variances variances = variances_of(pixels, mean);
    const float b = std::max(variances.alone - variances.shared, 0.f) / (1 - 1.f / PIXELS);
    const float a = variances.alone - b;
    const auto variance = [&](uint32_t n) { return a + b / static_cast<float>(n); };
    // Over that of the paths themselves.
    const auto rays_with = [&](uint32_t n) {
        return static_cast<float>(n - 1) / (PIXELS - 1) * rays_of_sharing / rays;
    };
    const auto effort = [&](uint32_t n) {
        return variance(n) * (1 + (n > 1 ? OVERHEAD : 0) + RAY * rays_with(n));
    };
    uint32_t best = 1;
    for (uint32_t n = 2; may_share && n <= PathReuse::MOST_PIXELS; n *= 2) {
        if (effort(n) < effort(best)) best = n;
    }
    // The sums are of squared differences of two means of 16 samples, over three channels.
    const float per_sample = SAMPLES / 2.f / 3 / static_cast<float>(pixels.size());
    return Pilot{best, luminance(mean), variance(best) * per_sample,
                 rays / (GROUPS * PIXELS * BLOCKS * SAMPLES) * (1 + rays_with(best))};
}

}  // namespace etendue
