#include "driver/renderer.h"

#include <oneapi/tbb/global_control.h>
#include <oneapi/tbb/info.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>
#include <xmmintrin.h>

#include <chrono>
#include <stdexcept>

namespace etendue {

namespace {

constexpr uint32_t TILE = 16;
// A pass is short enough for a picture and a clock reading to be had often, and long enough to keep threads
// busy.
constexpr double PASS_SECONDS = 0.25;

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) {
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Denormals as zero while in scope: Embree asks for it, and a dim path would otherwise cost a hundred bright
/// ones.
class FlushDenormals {
  public:
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | FLUSH_TO_ZERO | DENORMALS_ARE_ZERO); }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(const FlushDenormals&) = delete;
    FlushDenormals& operator=(const FlushDenormals&) = delete;

  private:
    static constexpr unsigned FLUSH_TO_ZERO = 0x8000, DENORMALS_ARE_ZERO = 0x0040;
    unsigned saved_;
};

}  // namespace

Renderer::Renderer(const Scene& scene, const Camera& camera, std::unique_ptr<Algorithm> algorithm,
                   const Settings& settings)
    : scene_(scene),
      camera_(camera),
      algorithm_(std::move(algorithm)),
      filter_(settings.filter),
      settings_(settings),
      threads_(settings.threads > 0 ? settings.threads : oneapi::tbb::info::default_concurrency()),
      film_(camera.width(), camera.height()),
      tiles_x_((camera.width() + TILE - 1) / TILE),
      tiles_y_((camera.height() + TILE - 1) / TILE) {}

void Renderer::resume(Film film) {
    if (film.width() != film_.width() || film.height() != film_.height()) {
        throw std::invalid_argument("the film is of another size than the camera");
    }
    film_ = std::move(film);
}

bool Renderer::render(uint64_t samples, double time_limit) {
    const Clock::time_point start = Clock::now();
    const double seconds_before = seconds_;
    // oneTBB itself would start no more threads than there are cores.
    using oneapi::tbb::global_control;
    const global_control allow(
        global_control::max_allowed_parallelism,
        std::max<size_t>(threads_, global_control::active_value(global_control::max_allowed_parallelism)));
    oneapi::tbb::task_arena arena(threads_);
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
        arena.execute([&] {
            oneapi::tbb::parallel_for(0u, tiles_x_ * tiles_y_, [&](uint32_t tile) {
                render_tile(tile, done);
                if (may_stop && seconds_since(start) > time_limit) stop_ = true;
            });
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

void Renderer::render_tile(uint32_t tile, uint64_t samples) {
    const FlushDenormals flush;
    Context context(scene_, Sampler(settings_.sampler, settings_.seed));
    const uint32_t x0 = tile % tiles_x_ * TILE, x1 = std::min(x0 + TILE, film_.width());
    const uint32_t y0 = tile / tiles_x_ * TILE, y1 = std::min(y0 + TILE, film_.height());
    uint64_t taken = 0;
    for (uint32_t y = y0; y < y1; ++y) {
        for (uint32_t x = x0; x < x1; ++x) taken += render_pixel(context, x, y, samples);
    }
    rays_ += context.rays;
    samples_done_ += taken;
}

uint64_t Renderer::render_pixel(Context& context, uint32_t x, uint32_t y, uint64_t samples) {
    Pixel& pixel = film_.at(x, y);
    // By place on the film, so that a pixel's samples do not depend on the size of the image.
    const uint32_t id = y << 16 | x;
    const uint64_t before = pixel.count;
    while (pixel.count < samples && !stop_) {
        const uint64_t sample = settings_.first_sample + pixel.count;
        context.sampler.start(id, sample);
        const vec2 film = vec2(x, y) + 0.5f + filter_.sample(context.sampler.next_2d());
        const Ray ray = camera_.ray(film, context.sampler.next_2d());
        if (!pixel.add(algorithm_->radiance(context, ray), sample)) report_invalid({x, y, sample});
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
