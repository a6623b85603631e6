#include "driver/light_image.h"

namespace etendue {

bool LightImage::trace(TileWorkers& workers, uint64_t begin, uint64_t end,
                       const std::function<bool()>& is_stopped,
                       const std::function<Observer*(uint32_t part)>& observe) {
    constexpr uint32_t PATHS_AT_ONCE = 1024;
    const uint32_t paths = algorithm_.light_paths();
    const uint32_t parts = (paths + PATHS_AT_ONCE - 1) / PATHS_AT_ONCE;
    if (parts == 0 || (first_ <= begin && end <= first_ + samples_.size())) return true;
    samples_.clear();
    first_ = begin;
    std::vector<std::vector<Splat>> landed(parts * (end - begin));
    std::atomic<bool> stopped = false;
    workers.in_order(static_cast<uint32_t>(landed.size()), [&](uint32_t i) {
        if (stopped || is_stopped()) {
            stopped = true;
            return;
        }
        const uint32_t first_path = i % parts * PATHS_AT_ONCE;
        landed[i] = trace_part(begin + i / parts, first_path, std::min(PATHS_AT_ONCE, paths - first_path),
                               observe ? observe(i) : nullptr);
    });
    if (stopped) return false;
    samples_.resize(end - begin);
    workers.in_order(static_cast<uint32_t>(samples_.size()), [&](uint32_t i) {
        samples_[i] = sorted(std::span(landed).subspan(size_t{i} * parts, parts));
    });
    return true;
}

std::vector<Splat> LightImage::trace_part(uint64_t sample, uint32_t first_path, uint32_t paths,
                                          Observer* observer) {
    // Other numbers than those of the pixels' paths.
    constexpr uint64_t LIGHT = 0x6c69676874ull << 20;
    const Sampler numbers(sensor_.sampler, mix_bits(sensor_.seed ^ LIGHT) + (sample >> 32));
    const vec2 size(sensor_.camera.width(), sensor_.camera.height());
    const float radius = sensor_.filter.radius();
    std::vector<Splat> all;
    Context context(scene_, numbers, observer);
    for (uint32_t i = first_path; i < first_path + paths; ++i) {
        context.sampler.start(numbers.stream(static_cast<uint32_t>(sample), i));
        const std::optional<Splat> splat = algorithm_.light_path(context, i);
        if (!splat) continue;
        sensor_.camera.for_each_image(splat->film, [&](const vec2& film) {
            const bool is_near =
                film.x > -radius && film.y > -radius && film.x < size.x + radius && film.y < size.y + radius;
            if (is_near) all.push_back({film, splat->found});
        });
    }
    rays_ += context.rays;
    return all;
}

LightImage::SampleImage LightImage::sorted(std::span<std::vector<Splat>> parts) const {
    SampleImage image;
    for (std::vector<Splat>& part : parts) {
        image.splats.insert(image.splats.end(), part.begin(), part.end());
        part = {};
    }
    // Stable, so that sums are the same on any number of threads.
    const auto row = [](const Splat& splat) { return static_cast<ptrdiff_t>(std::floor(splat.film.y)); };
    std::ranges::stable_sort(image.splats, {},
                             [&](const Splat& splat) { return std::pair(row(splat), splat.film.x); });
    image.rows.reserve(sensor_.camera.height() + 2 * MARGIN + 1);
    uint32_t next = 0;
    for (ptrdiff_t r = -MARGIN; r <= sensor_.camera.height() + MARGIN; ++r) {
        while (next < image.splats.size() && row(image.splats[next]) < r) ++next;
        image.rows.push_back(next);
    }
    return image;
}

}  // namespace etendue
