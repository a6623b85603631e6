#include "driver/light_image.h"

#include <cmath>
#include <numeric>

namespace etendue {

bool LightImage::trace(TileWorkers& workers, uint64_t begin, uint64_t end, const std::atomic<bool>& stop,
                       const std::function<Observer*()>& observe) {
    constexpr uint32_t PATHS_AT_ONCE = 1024;
    const uint32_t paths = algorithm_.light_paths();
    const uint32_t parts = (paths + PATHS_AT_ONCE - 1) / PATHS_AT_ONCE;
    samples_.clear();
    first_ = begin;
    if (parts == 0) return true;
    std::vector<std::vector<Landed>> landed(parts * (end - begin));
    workers.in_order(static_cast<uint32_t>(landed.size()), [&](uint32_t i) {
        if (stop) return;
        const uint32_t first_path = i % parts * PATHS_AT_ONCE;
        landed[i] = trace_part(begin + i / parts, first_path, std::min(PATHS_AT_ONCE, paths - first_path),
                               observe ? observe() : nullptr);
    });
    if (stop) return false;
    samples_.resize(end - begin);
    workers.in_order(static_cast<uint32_t>(samples_.size()), [&](uint32_t i) {
        samples_[i] = sorted(std::span(landed).subspan(size_t{i} * parts, parts));
    });
    return true;
}

std::vector<LightImage::Landed> LightImage::trace_part(uint64_t sample, uint32_t first_path, uint32_t paths,
                                                       Observer* observer) {
    // Other numbers than those of the pixels' paths.
    constexpr uint64_t LIGHT = 0x6c69676874ull << 20;
    const Sampler numbers(sensor_.sampler, mix_bits(sensor_.seed ^ LIGHT));
    std::vector<Landed> all;
    Context context(scene_, numbers, observer);
    for (uint32_t i = first_path; i < first_path + paths; ++i) {
        context.sampler.start(numbers.stream(static_cast<uint32_t>(sample), i));
        if (const std::optional<Splat> splat = algorithm_.light_path(context, i)) land(*splat, all);
    }
    rays_ += context.rays;
    return all;
}

void LightImage::land(const Splat& splat, std::vector<Landed>& all) const {
    const uint32_t width = sensor_.camera.width(), height = sensor_.camera.height();
    const auto pixels = [&](float film, uint32_t size) {
        // The centres of pixels are at halves.
        const float radius = sensor_.filter.radius(), last = static_cast<float>(size) - 1;
        return std::pair{static_cast<uint32_t>(std::clamp(std::ceil(film - radius - 0.5f), 0.f, last)),
                         static_cast<uint32_t>(std::clamp(std::floor(film + radius - 0.5f), 0.f, last))};
    };
    const auto [x0, x1] = pixels(splat.film.x, width);
    const auto [y0, y1] = pixels(splat.film.y, height);
    for (uint32_t y = y0; y <= y1; ++y) {
        for (uint32_t x = x0; x <= x1; ++x) {
            const float density = sensor_.filter.density(splat.film - vec2(x, y) - 0.5f);
            if (density == 0) continue;
            all.push_back({y * width + x, splat.found});
            all.back().found.unweighted *= density;
        }
    }
}

LightImage::SampleImage LightImage::sorted(std::span<const std::vector<Landed>> parts) const {
    std::vector<Landed> all;
    for (const auto& part : parts) all.insert(all.end(), part.begin(), part.end());
    // Stable, so that sums are the same on any number of threads.
    std::ranges::stable_sort(all, {}, &Landed::pixel);
    SampleImage image;
    const uint32_t width = sensor_.camera.width();
    for (const Landed& landed : all) {
        image.rows.resize(landed.pixel / width + 1, static_cast<uint32_t>(image.pixels.size()));
        image.pixels.push_back(landed.pixel);
        image.found.push_back(landed.found);
    }
    image.rows.resize(sensor_.camera.height() + 1, static_cast<uint32_t>(all.size()));
    return image;
}

std::span<const Contribution> LightImage::at(uint32_t x, uint32_t y, uint64_t index) const {
    if (samples_.empty()) return {};
    const SampleImage& image = samples_[index - first_];
    const auto begin = image.pixels.begin();
    const auto [first, last] =
        std::equal_range(begin + image.rows[y], begin + image.rows[y + 1], y * sensor_.camera.width() + x);
    return std::span(image.found).subspan(first - begin, last - first);
}

}  // namespace etendue
