#include "driver/renderer.h"

#include <chrono>
#include <stdexcept>

namespace etendue {

namespace {

// A pass is short enough for a picture and a clock reading to be had often, and long enough to keep threads
// busy.
constexpr double PASS_SECONDS = 0.25;

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

}  // namespace

Renderer::Renderer(const Scene& scene, const Camera& camera, std::unique_ptr<Algorithm> algorithm,
                   const Settings& settings)
    : scene_(scene),
      sensor_{camera, Filter(settings.filter), settings.sampler, settings.seed},
      algorithm_(std::move(algorithm)),
      first_sample_(settings.first_sample),
      threads_(thread_count(settings.threads)),
      film_(camera.width(), camera.height()),
      tiles_(camera.width(), camera.height()),
      tile_mutexes_(tiles_.count()) {}

void Renderer::resume(Film film) {
    if (film.width() != film_.width() || film.height() != film_.height()) {
        throw std::invalid_argument("the film is of another size than the camera");
    }
    film_ = std::move(film);
}

void Renderer::split(std::vector<ContributionSums> sums) {
    if (sums.size() != film_.pixels().size()) {
        throw std::invalid_argument("there must be one sum of contributions a pixel");
    }
    contributions_ = std::move(sums);
}

bool Renderer::render(uint64_t samples, double time_limit) {
    const Clock::time_point start = Clock::now();
    const double seconds_before = seconds_;
    TileWorkers workers(threads_);
    uint64_t done = samples, taken = 0;
    for (const Pixel& pixel : film_.pixels()) {
        done = std::min(done, pixel.count);
        taken += std::min(pixel.count, samples);
    }
    samples_done_ = taken;
    uint64_t pass = 1;
    while (done < samples && !stop_) {
        const Clock::time_point pass_start = Clock::now();
        const bool may_stop = done > 0;
        done += std::min(pass, samples - done);
        workers.for_each(tiles_, [&](uint32_t index, const Tile&) {
            render_tile(index, 1, done);
            if (may_stop && seconds_since(start) > time_limit) stop_ = true;
        });
        if (seconds_since(start) > time_limit) stop_ = true;
        seconds_ = seconds_before + seconds_since(start);
        const double per_sample = seconds_since(pass_start) / static_cast<double>(pass);
        pass = std::clamp<uint64_t>(static_cast<uint64_t>(PASS_SECONDS / per_sample), 1, 2 * pass);
    }
    seconds_ = seconds_before + seconds_since(start);
    stop_ = false;
    return std::ranges::all_of(film_.pixels(), [&](const Pixel& pixel) { return pixel.count >= samples; });
}

bool Renderer::render_coarse(uint32_t stride) {
    const Clock::time_point start = Clock::now();
    TileWorkers(threads_).for_each(tiles_,
                                   [&](uint32_t index, const Tile&) { render_tile(index, stride, 1); });
    seconds_ = seconds_ + seconds_since(start);
    return !stop_.exchange(false);
}

void Renderer::render_tile(uint32_t index, uint32_t stride, uint64_t samples) {
    const Tile tile = tiles_[index];
    const std::lock_guard lock(tile_mutexes_[index]);
    ContributionObserver observer;
    Context context(scene_, sensor_.make_sampler(), contributions_.empty() ? nullptr : &observer);
    uint64_t taken = 0;
    // A tile begins at a multiple of every stride that divides its side.
    for (uint32_t y = tile.y0; y < tile.y1; y += stride) {
        for (uint32_t x = tile.x0; x < tile.x1; x += stride) {
            taken += render_pixel(context, observer, x, y, samples);
        }
    }
    rays_ += context.rays;
    samples_done_ += taken;
}

uint64_t Renderer::render_pixel(Context& context, ContributionObserver& observer, uint32_t x, uint32_t y,
                                uint64_t samples) {
    Pixel& pixel = film_.at(x, y);
    const bool is_split = !contributions_.empty();
    const uint64_t before = pixel.count;
    while (pixel.count < samples && !stop_) {
        const uint64_t sample = first_sample_ + pixel.count;
        const Ray ray = sensor_.start(context.sampler, x, y, sample);
        if (is_split) observer.start();
        if (!pixel.add(algorithm_->radiance(context, ray), sample)) {
            report_invalid({x, y, sample});
        } else if (is_split) {
            observer.add_to(contributions_[size_t{y} * film_.width() + x]);
        }
    }
    return pixel.count - before;
}

void Renderer::report_invalid(const InvalidSample& sample) {
    ++invalid_count_;
    const std::lock_guard lock(invalid_mutex_);
    if (invalid_.size() < MAX_INVALID_LISTED) invalid_.push_back(sample);
}

std::vector<Renderer::InvalidSample> Renderer::invalid_samples() const {
    const std::lock_guard lock(invalid_mutex_);
    return invalid_;
}

}  // namespace etendue
