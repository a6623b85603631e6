#include "driver/ray_record.h"

#include <atomic>
#include <map>
#include <mutex>

#include "driver/sample_batch.h"
#include "driver/tiles.h"

namespace etendue {

namespace {

class Recorder : public Observer {
  public:
    void edge(const Ray& ray, const SurfaceHit&) override { rays.push_back({ray, false}); }
    void shadow_ray(const Ray& ray, bool) override { rays.push_back({ray, true}); }
    void portal_ray(const Ray& ray) override { rays.push_back({ray, false}); }
    void reuse_ray(const Ray& ray, bool) override { rays.push_back({ray, true}); }

    std::vector<TracedRay> rays;
};

}  // namespace

RayRecord::RayRecord(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, uint64_t samples,
                     int threads)
    : scene_(scene), width_(sensor.camera.width()), height_(sensor.camera.height()) {
    const Tiles tiles(width_, height_);
    tiles_.resize(tiles.count());
    const auto add = [&](uint32_t tile, const Recorder& recorder) {
        tiles_[tile].insert(tiles_[tile].end(), recorder.rays.begin(), recorder.rays.end());
    };
    TileWorkers workers(thread_count(threads));
    LightImage light(scene, sensor, algorithm);
    for (uint64_t begin = 0, end = 0; begin < samples; begin = end) {
        end = std::min(begin + light.samples_at_once(), samples);
        std::mutex mutex;
        std::map<uint32_t, Recorder> of_light;
        light.trace(
            workers, begin, end, [] { return false; },
            [&](uint32_t part) {
                const std::lock_guard lock(mutex);
                return &of_light[part];
            });
        for (const auto& [part, recorder] : of_light) add(part % tiles.count(), recorder);
        workers.for_each(tiles, [&](uint32_t index, const Tile& tile) {
            SampleBatch<Recorder> batch(scene, sensor, algorithm, light);
            const auto visit = [&](const auto& sample) { add(index, sample.listener); };
            batch.add(tile, begin, end, EVERY_SAMPLE, visit);
            batch.finish(visit);
        });
    }
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
