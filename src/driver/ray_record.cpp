#include "driver/ray_record.h"

#include <atomic>
#include <deque>
#include <mutex>

#include "driver/sample_batch.h"
#include "driver/tiles.h"

namespace etendue {

namespace {

class Recorder : public Observer {
  public:
    void edge(const Ray& ray, const SurfaceHit&) override { rays.push_back({ray, false}); }
    void shadow_ray(const Ray& ray, bool) override { rays.push_back({ray, true}); }
    void reuse_ray(const Ray& ray, bool) override { rays.push_back({ray, true}); }

    std::vector<TracedRay> rays;
};

}  // namespace

RayRecord::RayRecord(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, uint64_t samples,
                     int threads)
    : scene_(scene), width_(sensor.camera.width()), height_(sensor.camera.height()) {
    const Tiles tiles(width_, height_);
    tiles_.resize(tiles.count());
    TileWorkers workers(thread_count(threads));
    LightImage light(scene, sensor, algorithm);
    std::mutex mutex;
    std::deque<Recorder> of_light;  // which stay where they are
    light.trace(workers, 0, samples, false, [&] {
        const std::lock_guard lock(mutex);
        return &of_light.emplace_back();
    });
    for (size_t i = 0; i < of_light.size(); ++i) {
        auto& rays = tiles_[i % tiles.count()];
        rays.insert(rays.end(), of_light[i].rays.begin(), of_light[i].rays.end());
    }
    workers.for_each(tiles, [&](uint32_t index, const Tile& tile) {
        SampleBatch<Recorder> batch(scene, sensor, algorithm, light);
        const auto visit = [&](const auto& sample) {
            const auto& rays = sample.listener.rays;
            tiles_[index].insert(tiles_[index].end(), rays.begin(), rays.end());
        };
        batch.add(tile, 0, samples, EVERY_SAMPLE, visit);
        batch.finish(visit);
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
