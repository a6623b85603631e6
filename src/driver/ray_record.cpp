#include "driver/ray_record.h"

#include <atomic>

#include "driver/sample_batch.h"
#include "driver/tiles.h"

namespace etendue {

namespace {

class Recorder : public Observer {
  public:
    void edge(const Ray& ray, const SurfaceHit&) override { rays.push_back({ray, false}); }
    void shadow_ray(const Ray& ray, bool) override { rays.push_back({ray, true}); }

    std::vector<TracedRay> rays;
};

}  // namespace

RayRecord::RayRecord(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, uint64_t samples,
                     int threads)
    : scene_(scene), width_(sensor.camera.width()), height_(sensor.camera.height()) {
    const Tiles tiles(width_, height_);
    tiles_.resize(tiles.count());
    TileWorkers(thread_count(threads)).for_each(tiles, [&](uint32_t index, const Tile& tile) {
        SampleBatch<Recorder> batch(sensor);
        const auto flush = [&] {
            batch.estimate(algorithm, scene, [&](const auto& sample) {
                const auto& rays = sample.listener.rays;
                tiles_[index].insert(tiles_[index].end(), rays.begin(), rays.end());
            });
        };
        for (uint32_t y = tile.y0; y < tile.y1; ++y) {
            for (uint32_t x = tile.x0; x < tile.x1; ++x) {
                for (uint64_t sample = 0; sample < samples; ++sample) {
                    batch.add(x, y, sample);
                    if (batch.is_full()) flush();
                }
            }
        }
        flush();
    });
}

uint64_t RayRecord::replay(int threads) const {
    std::atomic<uint64_t> hits = 0;
    TileWorkers(thread_count(threads)).for_each(Tiles(width_, height_), [&](uint32_t index, const Tile&) {
        hits += scene_.trace(tiles_[index]);
    });
    return hits;
}

uint64_t RayRecord::rays() const {
    uint64_t rays = 0;
    for (const auto& tile : tiles_) rays += tile.size();
    return rays;
}

}  // namespace etendue
