// Who renders what when: passes over tiles on all threads, with progress, cancelling and a count of what went
// wrong.
#pragma once

#include <atomic>
#include <functional>
#include <memory>
#include <mutex>

#include "algorithms/algorithm.h"
#include "driver/beauty.h"
#include "driver/contributions.h"
#include "driver/film_error.h"
#include "driver/films.h"
#include "driver/light_image.h"
#include "gi/film.h"

namespace etendue {

class Renderer {
  public:
    struct Settings {
        Sampler::Kind sampler = Sampler::Kind::sobol;
        Filter::Kind filter = Filter::Kind::blackman_harris;
        uint64_t seed = 0;
        uint64_t first_sample = 0;          // index of the first sample of each pixel
        int threads = 0;                    // 0: all
        std::shared_ptr<Films> films = {};  // where its film comes from and goes to; null: nowhere
        bool prepares = true;  // false: the estimator learns nothing before, and has noise of another size
    };
    /// A sample whose radiance was not a finite number >= 0; it is not in the film's sums.
    struct InvalidSample {
        uint32_t x, y;
        uint64_t sample;
    };

    /// The scene must outlive the renderer.
    Renderer(const Scene& scene, const Camera& camera, std::unique_ptr<Algorithm> algorithm,
             const Settings& settings);
    ~Renderer();

    /// Brings every pixel to `samples` samples, going on from those it has. False where it returned before
    /// that: cancelled, or `time_limit` seconds had passed, with every pixel at the number of samples that
    /// its count says. The limit does not stop the first sample of each pixel.
    bool render(uint64_t samples, double time_limit = INFINITE);

    /// Gives the pixels whose x and y are multiples of `stride` their first sample: a coarse picture early, of
    /// samples that `render` then need not take. False where it was cancelled.
    bool render_coarse(uint32_t stride);

    /// A beauty render: every pixel gets BEAUTY_MINIMUM samples, then the worst tiles more, until the film's error
    /// is within the bound. False where it returned before that, as above. How many samples a pixel has in the
    /// end depends on the samples alone, not on threads or interruptions.
    bool render_until(double error_bound, double time_limit = INFINITE);

    /// Whether the estimator has anything to learn in this scene.
    bool learns() const { return algorithm_->learns(scene_); }
    /// Lets the estimator learn what it wants to know before its first sample, as a render would. False where it was
    /// cancelled.
    bool prepare();

    /// Makes the running `render`, or else the next, return within a few milliseconds. From any thread.
    void cancel() { stop_ = true; }

    /// Of the running or last `render`: pixels x samples that it was asked for and has. Of `render_until`: all
    /// that it has.
    uint64_t samples_done() const { return samples_done_; }
    /// How many `render_until` expects to have in the end; 0 while it cannot tell.
    double samples_expected() const { return samples_expected_; }
    /// The film's error as it was when the running or last render last looked; infinite where it cannot tell.
    double error() const { return error_; }

    const Scene& scene() const { return scene_; }
    const Sensor& sensor() const { return sensor_; }
    /// Ready for estimates: learns first what it wants to know, where that has not been done. From any thread.
    const Algorithm& algorithm();
    /// While nothing renders; `read` is for all other times.
    const Film& film() const { return film_; }
    /// Calls visit(tile, film) for one tile after the other, each at a moment when nobody renders it: at any
    /// time, from any thread.
    template <class Visit>
    void read(const Visit& visit) const {
        for (uint32_t i = 0; i < tiles_.count(); ++i) {
            const std::lock_guard lock(tile_mutexes_[i]);
            visit(tiles_[i], film_);
        }
    }
    /// One pixel at such a moment.
    Pixel read(uint32_t x, uint32_t y) const {
        const std::lock_guard lock(tile_mutexes_[tiles_.index_of(x, y)]);
        return film_.pixels()[size_t{y} * film_.width() + x];
    }
    /// Goes on from another film of the same size, scene, settings and first sample. Throws
    /// std::invalid_argument for another size.
    void resume(Film film);

    /// From now on keeps the contributions of all samples apart, going on from `sums`, one a pixel; of zeros
    /// where nothing is rendered yet. Throws std::invalid_argument for another number of pixels.
    void split(std::vector<ContributionSums> sums);
    /// Empty without `split`.
    const std::vector<ContributionSums>& contributions() const { return contributions_; }

    /// Without those of the estimator's preparation.
    uint64_t rays() const { return rays_; }
    uint64_t invalid_count() const { return invalid_count_; }
    /// The first of them, at most MAX_INVALID_LISTED.
    std::vector<InvalidSample> invalid_samples() const;
    double seconds() const { return seconds_; }
    int threads() const { return threads_; }

    static constexpr size_t MAX_INVALID_LISTED = 1000;

  private:
    bool prepare(const std::atomic<bool>& cancelled);
    /// The tiles' errors, and the film's for others to see.
    std::vector<TileError> look(TileWorkers& workers);
    /// All the samples of a stage of a beauty render, of tiles that have these.
    void render_goals(TileWorkers& workers, std::span<const TileGoal> goals, std::span<const TileError> tiles,
                      const std::function<bool()>& is_stopped);
    /// Before samples [begin, end) of pixels, counted from those of the film. False where it was stopped.
    bool trace_light(TileWorkers& workers, uint64_t begin, uint64_t end,
                     const std::function<bool()>& is_stopped);
    void render_tile(uint32_t index, uint32_t stride, uint64_t samples);
    template <class Listener>
    void render_tile(const Tile& tile, uint32_t stride, uint64_t samples);
    void report_invalid(const InvalidSample& sample);

    const Scene& scene_;
    Sensor sensor_;
    std::unique_ptr<Algorithm> algorithm_;
    std::mutex prepare_mutex_;
    bool is_prepared_;
    uint64_t first_sample_;
    int threads_;
    std::shared_ptr<Films> films_;
    Film film_;
    LightImage light_;  // of the samples that tiles are rendered by
    Tiles tiles_;
    mutable std::vector<std::mutex> tile_mutexes_;  // held by who renders a tile, or reads it
    std::vector<ContributionSums> contributions_;
    std::atomic<bool> stop_ = false;
    std::atomic<uint64_t> rays_ = 0, samples_done_ = 0, invalid_count_ = 0;
    std::atomic<double> seconds_ = 0, error_ = INFINITE, samples_expected_ = 0;
    mutable std::mutex invalid_mutex_;
    std::vector<InvalidSample> invalid_;
};

}  // namespace etendue
