#include "driver/renderer.h"

#include <chrono>
#include <stdexcept>

#include "driver/sample_batch.h"

namespace etendue {

namespace {

// A pass is short enough for a picture and a clock reading to be had often, and long enough to keep threads
// busy.
constexpr double PASS_SECONDS = 0.25;
// The error is worth a look at the whole film this often.
constexpr double LOOK_SECONDS = 1;

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
      is_prepared_(!settings.prepares || !algorithm_->learns(scene)),
      first_sample_(settings.first_sample),
      threads_(thread_count(settings.threads)),
      films_(settings.films),
      film_(films_ ? films_->take(camera.width(), camera.height(), threads_)
                   : Film(camera.width(), camera.height())),
      light_(scene_, sensor_, *algorithm_),
      tiles_(camera.width(), camera.height()),
      tile_mutexes_(tiles_.count()) {}

Renderer::~Renderer() {
    if (films_) films_->give_back(std::move(film_));
}

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
    Clock::time_point looked = start;
    const bool is_ready = done < samples && prepare(stop_);
    while (is_ready && done < samples && !stop_) {
        const Clock::time_point pass_start = Clock::now();
        const bool may_stop = done > 0;
        const uint64_t before = done;
        pass = std::min(pass, light_.samples_at_once());
        done += std::min(pass, samples - done);
        const auto is_stopped = [&] { return stop_ || (may_stop && seconds_since(start) > time_limit); };
        if (!trace_light(workers, before, done, is_stopped)) break;
        workers.for_each(tiles_, [&](uint32_t index, const Tile&) {
            render_tile(index, 1, done);
            if (may_stop && seconds_since(start) > time_limit) stop_ = true;
        });
        if (seconds_since(start) > time_limit) stop_ = true;
        seconds_ = seconds_before + seconds_since(start);
        const double per_sample = seconds_since(pass_start) / static_cast<double>(pass);
        pass = std::clamp<uint64_t>(static_cast<uint64_t>(PASS_SECONDS / per_sample), 1, 2 * pass);
        if (seconds_since(looked) > LOOK_SECONDS) {
            look(workers);
            looked = Clock::now();
        }
    }
    // Who cancels is waiting.
    if (!stop_ || seconds_since(start) > time_limit) look(workers);
    light_.forget();
    seconds_ = seconds_before + seconds_since(start);
    stop_ = false;
    return std::ranges::all_of(film_.pixels(), [&](const Pixel& pixel) { return pixel.count >= samples; });
}

bool Renderer::render_coarse(uint32_t stride) {
    const Clock::time_point start = Clock::now();
    TileWorkers workers(threads_);
    if (prepare(stop_) && trace_light(workers, 0, 1, [&] { return stop_.load(); }))
        workers.for_each(tiles_, [&](uint32_t index, const Tile&) { render_tile(index, stride, 1); });
    seconds_ = seconds_ + seconds_since(start);
    return !stop_.exchange(false);
}

bool Renderer::render_until(double error_bound, double time_limit) {
    const Clock::time_point start = Clock::now();
    const auto has_minimum = [](const Pixel& pixel) { return pixel.count >= BEAUTY_MINIMUM; };
    samples_expected_ = 0;
    if (!std::ranges::all_of(film_.pixels(), has_minimum) && !render(BEAUTY_MINIMUM, time_limit))
        return false;
    const double seconds_before = seconds_ - seconds_since(start);
    TileWorkers workers(threads_);
    uint64_t taken = 0;
    for (const Pixel& pixel : film_.pixels()) taken += pixel.count;
    samples_done_ = taken;
    bool complete = false;
    const bool is_ready = prepare(stop_);
    while (is_ready && !stop_) {
        const std::vector<TileError> errors = look(workers);
        samples_expected_ = samples_at(errors, tiles_, error_bound);
        const std::vector<TileGoal> goals = next_goals(errors, error_bound);
        complete = goals.empty();
        if (complete) break;
        render_goals(workers, goals, errors, [&] { return stop_ || seconds_since(start) > time_limit; });
        if (seconds_since(start) > time_limit) stop_ = true;
        seconds_ = seconds_before + seconds_since(start);
    }
    light_.forget();
    seconds_ = seconds_before + seconds_since(start);
    stop_ = false;
    return complete;
}

void Renderer::render_goals(TileWorkers& workers, std::span<const TileGoal> goals,
                            std::span<const TileError> tiles, const std::function<bool()>& is_stopped) {
    const auto fewest = [&](const TileGoal& goal) { return tiles[goal.tile].fewest; };
    uint64_t begin = 0;
    for (;;) {
        uint64_t next = std::numeric_limits<uint64_t>::max(), most = 0;
        for (const TileGoal& goal : goals) {
            if (goal.samples <= begin) continue;
            next = std::min(next, std::max(fewest(goal), begin));
            most = std::max(most, goal.samples);
        }
        if (most == 0) return;
        begin = next;
        const uint64_t end = std::min(begin + light_.samples_at_once(), most);
        if (is_stopped() || !trace_light(workers, begin, end, is_stopped)) return;
        workers.in_order(goals.size(), [&](uint32_t index) {
            const TileGoal& goal = goals[index];
            const uint64_t stop = std::min(end, goal.samples);
            // In pieces, so that the tile can be read and the clock is looked at meanwhile.
            for (uint64_t samples = std::max(fewest(goal), begin); samples < stop && !is_stopped();) {
                samples = std::min(samples + PixelGroups::BLOCK, stop);
                render_tile(goal.tile, 1, samples);
            }
        });
        begin = end;
    }
}

bool Renderer::prepare() {
    const bool is_ready = prepare(stop_);
    if (!is_ready) stop_ = false;
    return is_ready;
}

bool Renderer::prepare(const std::atomic<bool>& cancelled) {
    const std::lock_guard lock(prepare_mutex_);
    if (is_prepared_) return true;
    const auto for_each = [&](uint32_t count, const std::function<void(uint32_t)>& work) {
        std::atomic<uint32_t> done = 0;
        TileWorkers(threads_).in_order(count, [&](uint32_t i) {
            if (!cancelled) work(i), ++done;
        });
        return done == count;
    };
    return is_prepared_ = algorithm_->prepare({scene_, sensor_.camera, for_each});
}

const Algorithm& Renderer::algorithm() {
    static const std::atomic<bool> never = false;
    prepare(never);
    return *algorithm_;
}

std::vector<TileError> Renderer::look(TileWorkers& workers) {
    std::vector<TileError> errors = tile_errors(film_, workers, algorithm_->sharing());
    error_ = film_error(errors).error;
    return errors;
}

bool Renderer::trace_light(TileWorkers& workers, uint64_t begin, uint64_t end,
                           const std::function<bool()>& is_stopped) {
    const uint64_t rays_before = light_.rays();
    const bool is_complete = light_.trace(workers, first_sample_ + begin, first_sample_ + end, is_stopped);
    rays_ += light_.rays() - rays_before;
    return is_complete;
}

void Renderer::render_tile(uint32_t index, uint32_t stride, uint64_t samples) {
    const std::lock_guard lock(tile_mutexes_[index]);
    if (contributions_.empty()) {
        render_tile<Unobserved>(tiles_[index], stride, samples);
    } else {
        render_tile<ContributionObserver>(tiles_[index], stride, samples);
    }
}

template <class Listener>
void Renderer::render_tile(const Tile& tile, uint32_t stride, uint64_t samples) {
    SampleBatch<Listener> batch(scene_, sensor_, *algorithm_, light_, &stop_);
    uint64_t taken = 0;
    const auto visit = [&](const auto& sample) {
        ++taken;
        if (!film_.at(sample.x, sample.y).add(sample.radiance, sample.index)) {
            report_invalid({sample.x, sample.y, sample.index});
        } else if constexpr (std::is_same_v<Listener, ContributionObserver>) {
            sample.listener.add_to(contributions_[size_t{sample.y} * film_.width() + sample.x]);
        }
    };
    std::array<uint64_t, Tiles::SIDE * Tiles::SIDE> counts{};
    const auto count = [&](uint32_t x, uint32_t y) -> uint64_t& {
        return counts[(y - tile.y0) * Tiles::SIDE + x - tile.x0];
    };
    uint64_t fewest = samples;
    for (uint32_t y = tile.y0; y < tile.y1; ++y) {
        for (uint32_t x = tile.x0; x < tile.x1; ++x) {
            count(x, y) = film_.at(x, y).count;
            fewest = std::min(fewest, count(x, y));
        }
    }
    // A tile begins at a multiple of every stride that divides its side.
    const auto is_missing = [&](const PixelGroups::Place& place, uint64_t index) {
        return first_sample_ + count(place.x, place.y) <= index && (place.x | place.y) % stride == 0;
    };
    batch.add(tile, first_sample_ + fewest, first_sample_ + samples, is_missing, visit);
    batch.finish(visit);
    rays_ += batch.rays();
    samples_done_ += taken;
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
