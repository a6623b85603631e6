#include "driver/techniques.h"

#include <stdexcept>
#include <utility>

#include "driver/sample_batch.h"
#include "driver/tiles.h"

namespace etendue {

namespace {

/// Keeps what one sample found.
class TechniqueObserver : public Observer {
  public:
    void contribution(const Contribution& found) override { all.push_back(found); }

    std::vector<Contribution> all;
};

}  // namespace

/// Adds up what one sample found: the variance is that of whole samples, which may find light several times.
class TechniqueSums {
  public:
    explicit TechniqueSums(int max_edges)
        : max_edges_(max_edges), found_(2 * TECHNIQUES.size() * max_edges) {}

    void add(const Contribution& found) {
        const int edges = std::min(static_cast<int>(found.edges), max_edges_);
        const size_t row = static_cast<size_t>(found.technique) * max_edges_ + edges - 1;
        found_[row] += found.unweighted * found.weight;
        found_[row + found_.size() / 2] += found.unweighted;
        longest_ = std::max(longest_, edges);
    }

    /// Moves what was found to a pixel's sums, and begins anew. What is no finite number is left out, as from
    /// the film.
    void move_to(TechniqueFilm::Sums* sums) {
        for (size_t row = 0; row < found_.size(); row += max_edges_) {
            for (size_t i = row; i < row + longest_; ++i) {
                const vec3 value = std::exchange(found_[i], vec3(0));
                if (!(value.x >= 0 && value.y >= 0 && value.z >= 0 && max_component(value) < INFINITE))
                    continue;
                sums[i].sum += value;
                sums[i].sum_squares += glm::dvec3(value) * glm::dvec3(value);
            }
        }
        longest_ = 0;
    }

  private:
    int max_edges_, longest_ = 0;
    std::vector<vec3> found_;  // weighted, then unweighted; for each technique, by edges
};

TechniqueFilm::TechniqueFilm(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm,
                             int max_edges, int threads)
    : scene_(scene), sensor_(sensor), algorithm_(algorithm), max_edges_(max_edges), threads_(threads) {
    if (max_edges < 1) throw std::invalid_argument("max_edges: at least 1 is needed");
    sums_.resize(size_t{width()} * height() * slots());
}

bool TechniqueFilm::render(uint64_t samples) {
    samples_done_ = 0;
    TileWorkers workers(threads_);
    LightImage light(scene_, sensor_, algorithm_);
    const uint64_t all = samples_ + samples;
    for (uint64_t begin = samples_; begin < all && !stop_;) {
        const uint64_t end = std::min(begin + light.samples_at_once(), all);
        if (!light.trace(workers, begin, end, [&] { return stop_.load(); })) break;
        workers.for_each(Tiles(width(), height()), [&](uint32_t, const Tile& tile) {
            SampleBatch<TechniqueObserver> batch(scene_, sensor_, algorithm_, light, &stop_);
            TechniqueSums sums(max_edges_);
            const auto visit = [&](const auto& sample) {
                ++samples_done_;
                for (const Contribution& found : sample.listener.all) sums.add(found);
                sums.move_to(&sums_[slot(pixel(sample.x, sample.y), weighted, Technique::bsdf_sampling, 1)]);
            };
            batch.add(tile, begin, end, EVERY_SAMPLE, visit);
            batch.finish(visit);
        });
        begin = end;
    }
    if (stop_.exchange(false)) return false;
    samples_ += samples;
    return true;
}

}  // namespace etendue
