// What an estimator's paths from lights bring to the film, sample by sample: see Algorithm::light_paths.
//
// They land anywhere, so they are traced before the samples of pixels which they belong to, for the whole image at once.
#pragma once

#include <vector>

#include "algorithms/algorithm.h"
#include "driver/sensor.h"
#include "driver/tiles.h"

namespace etendue {

class LightImage {
  public:
    LightImage(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm)
        : scene_(scene), sensor_(sensor), algorithm_(algorithm) {}

    /// How many samples are to be traced at once at most, so that few paths are kept; any number where there are none.
    uint64_t samples_at_once() const {
        constexpr uint64_t PATHS = 1 << 20, MOST = 16, ANY = std::numeric_limits<uint64_t>::max() / 2;
        const uint64_t paths = algorithm_.light_paths();
        return paths == 0 ? ANY : std::clamp<uint64_t>(PATHS / paths, 1, MOST);
    }

    /// Traces what belongs to samples [begin, end), and forgets all others. `observe(part)`, where given, is told of the rays of
    /// a part of the paths. False, with nothing known, where `is_stopped` came true meanwhile.
    bool trace(TileWorkers& workers, uint64_t begin, uint64_t end, const std::function<bool()>& is_stopped,
               const std::function<Observer*(uint32_t part)>& observe = {});
    void forget() { samples_.clear(); }

    /// Calls visit(contribution) for all that lands on a pixel in one of these samples.
    void for_each(uint32_t x, uint32_t y, uint64_t index, const auto& visit) const {
        if (samples_.empty()) return;
        const vec2 centre = vec2(x, y) + 0.5f;
        const float radius = sensor_.filter.radius();
        const SampleImage& image = samples_[index - first_];
        const auto last_row = static_cast<ptrdiff_t>(std::floor(centre.y + radius));
        for (auto row = static_cast<ptrdiff_t>(std::floor(centre.y - radius)); row <= last_row; ++row) {
            // Places may be outside of the film, by the filter's radius.
            const auto first = image.splats.begin() + image.rows[row + MARGIN];
            const auto end = image.splats.begin() + image.rows[row + MARGIN + 1];
            for (auto splat = std::ranges::lower_bound(first, end, centre.x - radius, {}, film_x);
                 splat != end && splat->film.x <= centre.x + radius; ++splat) {
                const float density = sensor_.filter.density(splat->film - centre);
                if (density == 0) continue;
                Contribution found = splat->found;
                found.unweighted *= density;
                visit(found);
            }
        }
    }

    /// That were traced.
    uint64_t rays() const { return rays_; }

  private:
    static constexpr ptrdiff_t MARGIN = 2;  // rows above and below the film
    static float film_x(const Splat& splat) { return splat.film.x; }

    /// Of a sample of the whole image: splats by rows and from left to right, and where each row begins.
    struct SampleImage {
        std::vector<Splat> splats;
        std::vector<uint32_t> rows;
    };
    std::vector<Splat> trace_part(uint64_t sample, uint32_t first_path, uint32_t paths, Observer* observer);
    SampleImage sorted(std::span<std::vector<Splat>> parts) const;

    const Scene& scene_;
    const Sensor& sensor_;
    const Algorithm& algorithm_;
    uint64_t first_ = 0;
    std::vector<SampleImage> samples_;
    std::atomic<uint64_t> rays_ = 0;
};

}  // namespace etendue
