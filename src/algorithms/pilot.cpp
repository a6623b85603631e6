#include "algorithms/pilot.h"

#include <numeric>

namespace etendue {

namespace {

// Random numbers that no render uses.
constexpr uint64_t SEED = 0xf11e7ca3b0a7ull;
// The variance is that of two blocks of Sobol's sequence, so what stratification does to it is in it.
constexpr uint32_t GROUPS_ACROSS = 7, GROUPS = GROUPS_ACROSS * GROUPS_ACROSS, PIXELS = 8, BLOCKS = 2,
                   SAMPLES = 8;
constexpr float ALL_SAMPLES = GROUPS * PIXELS * BLOCKS * SAMPLES;
constexpr uint32_t TILE = 16;  // side of the square that the pixels of a group are in
// The largest variances, which may be those of rare bright samples, are left out: one in so many.
constexpr uint32_t LEFT_OUT = 20;
// Of the square of the image's mean: what is added to a pixel's, so that the darkest do not decide.
constexpr float EPSILON = 0.01f;
// What takes time, as measured on the bundled scenes, by that of one ray of a path: to come back to the first surface, and there
// a look at a partner's path and a light that is sampled.
constexpr float COME_BACK = 0.7f, PARTNER = 0.7f, LIGHT = 1;
// Where pixels that are left out gain nothing, a smaller gain of the others would be a loss in the whole picture.
constexpr float WORTHWHILE = 1.2f;

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
    vec3 portal_gain{0};  // of a sample
};

/// What the trials of all groups tell.
struct Measured {
    std::vector<PixelMeans> pixels;
    float rays = 0, rays_of_sharing = 0;  // of a sample

    explicit Measured(std::span<const Trial> trials) {
        for (const Trial& trial : trials) {
            PixelMeans* const group = &*pixels.insert(pixels.end(), PIXELS, {});
            for (size_t i = 0; i < trial.estimates.size(); ++i) {
                const size_t block = i / PIXELS / SAMPLES;
                group[i % PIXELS].alone[block] += trial.estimates[i].alone / float{SAMPLES};
                group[i % PIXELS].shared[block] += trial.estimates[i].shared / float{SAMPLES};
                if (!trial.portal_gains.empty())
                    group[i % PIXELS].portal_gain += trial.portal_gains[i] / float{SAMPLES * BLOCKS};
            }
            rays += static_cast<float>(trial.rays) / ALL_SAMPLES;
            rays_of_sharing += static_cast<float>(trial.rays_of_sharing) / ALL_SAMPLES;
        }
    }
};

/// What variances are relative to: of each pixel the square of its mean, by the best estimates that there are. By its own, an
/// estimate would hide how far off it is.
struct Scales {
    vec3 mean{0};  // of all pixels
    std::vector<vec3> squares;

    explicit Scales(const Measured& best) {
        for (const PixelMeans& pixel : best.pixels) {
            const vec3 of_pixel = 0.5f * (pixel.shared[0] + pixel.shared[1]);
            mean += of_pixel / static_cast<float>(best.pixels.size());
            squares.push_back(of_pixel * of_pixel);
        }
        for (vec3& square : squares) square += EPSILON * mean * mean + 1e-30f;
    }
};

/// The sum of the relative variances of all pixels but the noisiest.
float variance_of(const Measured& measured, const Scales& scales,
                  std::array<vec3, BLOCKS> PixelMeans::* means) {
    std::vector<float> variances;
    for (size_t i = 0; i < measured.pixels.size(); ++i) {
        const std::array<vec3, BLOCKS>& blocks = measured.pixels[i].*means;
        const vec3 difference = blocks[0] - blocks[1];
        variances.push_back(dot(difference * difference / scales.squares[i], vec3(1)));
    }
    std::ranges::sort(variances);
    variances.resize(variances.size() - variances.size() / LEFT_OUT);
    return std::accumulate(variances.begin(), variances.end(), 0.f);
}

/// What portals take away of the variances of all pixels.
float gain_of_portals(const Measured& measured, const Scales& scales) {
    float gain = 0;
    for (size_t i = 0; i < measured.pixels.size(); ++i) {
        gain += dot(measured.pixels[i].portal_gain / scales.squares[i], vec3(2.f / SAMPLES));
    }
    return gain;
}

/// How many paths of a pixel's own the paths of so many that share are worth to it. A partner's is worth less than one, as it
/// may be unlikely from this pixel's surface: 0.25 to 0.7 on the bundled scenes, by renders with 1 to 16 pixels.
float worth(uint32_t pixels) { return 1 + 0.5f * static_cast<float>(pixels - 1); }

/// Of a variance the part that `n` times as many samples of something would bring down to its nth.
float part_of(float variance, float variance_with, float n) {
    return std::max(variance - variance_with, 0.f) / (1 - 1 / n);
}

}  // namespace

std::optional<Pilots> fly(const Preparation& preparation, const Allowed& allowed, const Try& attempt) {
    const uint32_t most_pixels = allowed.sharing ? PathReuse::MOST_PIXELS : 1,
                   most_lights = allowed.light_samples ? MOST_LIGHT_SAMPLES : 1;
    // All groups by each of these: as a path would by itself, with several lights, by portals.
    const std::array<Together, 3> ways{Together{allowed.sharing, 1, false},
                                       {allowed.sharing, most_lights, false},
                                       {allowed.sharing, 1, allowed.portals}};
    std::vector<uint32_t> tried{0};
    if (allowed.light_samples) tried.push_back(1);
    if (allowed.portals) tried.push_back(2);
    std::vector<Trial> trials(tried.size() * GROUPS);
    const bool complete = preparation.for_each(static_cast<uint32_t>(trials.size()), [&](uint32_t i) {
        GroupQueue queue(preparation.camera, i % GROUPS);
        trials[i] = attempt(queue, ways[tried[i / GROUPS]]);
    });
    if (!complete) return std::nullopt;
    const std::span<const Trial> all = trials;
    const auto measured = [&](uint32_t way) {
        const auto at = std::ranges::find(tried, way);
        return Measured(all.subspan(at == tried.end() ? 0 : (at - tried.begin()) * GROUPS, GROUPS));
    };
    const Measured one = measured(0), several = measured(1), portals = measured(2);
    const Scales scales(several);
    const float one_alone = variance_of(one, scales, &PixelMeans::alone),
                one_shared = variance_of(one, scales, &PixelMeans::shared),
                several_alone = variance_of(several, scales, &PixelMeans::alone),
                several_shared = variance_of(several, scales, &PixelMeans::shared),
                portals_shared = variance_of(portals, scales, &PixelMeans::shared);

    // As in pilot.h; d is what portals take away, which has noise that is too rare for trials without them to tell.
    const float b = (part_of(one_alone, one_shared, worth(PIXELS)) +
                     part_of(several_alone, several_shared, worth(PIXELS))) /
                    2;
    const float c = part_of(one_shared, several_shared, MOST_LIGHT_SAMPLES);
    const float d = gain_of_portals(portals, scales);
    const float a = std::max(portals_shared - b / worth(PIXELS) - c, 0.f);
    const auto variance = [&](const Pilot& of) {
        return a + b / worth(of.sharing) + c / static_cast<float>(of.light_samples);
    };
    // More rays than those of the path, and with them its time, in rays.
    const auto to_partners = [&](const Pilot& of) {
        return static_cast<float>(of.sharing - 1) / (PIXELS - 1) * one.rays_of_sharing;
    };
    const auto to_lights = [&](const Pilot& of) {
        return static_cast<float>(of.light_samples - 1) / (MOST_LIGHT_SAMPLES - 1) *
               (several.rays - one.rays);
    };
    const auto to_portals = [&](const Pilot& of) { return of.by_portals ? portals.rays - one.rays : 0; };
    const auto time = [&](const Pilot& of) {
        const bool comes_back = of.sharing > 1 || of.light_samples > 1 || of.by_portals;
        return one.rays + (comes_back ? COME_BACK : 0) + PARTNER * to_partners(of) +
               LIGHT * (to_lights(of) + to_portals(of));
    };
    const auto effort = [&](const Pilot& of) { return variance(of) * time(of); };
    const auto best_of = [&](bool by_portals) {
        const Pilot plain{1, 1, by_portals};
        Pilot best = plain;
        for (uint32_t pixels = 1; pixels <= most_pixels; pixels *= 2) {
            for (uint32_t lights = 1; lights <= most_lights; lights *= 2) {
                const Pilot other{pixels, lights, by_portals};
                if (effort(other) < effort(best)) best = other;
            }
        }
        if (effort(plain) < WORTHWHILE * effort(best)) best = plain;
        best.luminance = luminance(scales.mean);
        // The sums are of squared differences of two means of so many samples, over three channels.
        best.relative_variance = variance(best) * (SAMPLES / 2.f / 3 / static_cast<float>(one.pixels.size()));
        best.rays = one.rays + to_partners(best) + to_lights(best) + to_portals(best);
        return best;
    };
    const Pilot without = best_of(false), with = best_of(allowed.portals);
    // With portals some of that rare noise stays, which hides as well: on `sibenik` half of the gain comes.
    constexpr float EXPECTED = 2;
    const bool pays = EXPECTED * effort(with) < (variance(without) + d) * time(without);
    return Pilots{pays ? with : without, without};
}

}  // namespace etendue
