#include "driver/replay.h"

#include "driver/sample_batch.h"
#include "driver/tiles.h"

namespace etendue {

namespace {

class Recorder : public Observer {
  public:
    void edge(const Ray& ray, const SurfaceHit& hit) override {
        here_ = path.vertices.size();
        path.vertices.push_back({ray, hit, throughput_, {}, {}, {}, {}});
    }
    void shadow_ray(const Ray& ray, bool visible) override { here().shadow_rays.push_back({ray, visible}); }
    void back_at_first() override { here_ = 0; }
    void bounce(const BsdfSample& sample) override {
        if (!sample.exists) return;
        here().bounce = sample;
        throughput_ *= sample.weight;
    }
    void roulette(float q, bool survived) override {
        here().roulette = {q, survived};
        if (survived) throughput_ /= 1 - q;
    }
    void contribution(const Contribution& found) override {
        if (found.borrowed) return path.borrowed.push_back(found);
        if (found.from_light) return path.from_lights.push_back(found);
        if (found.by_portal) return path.by_portals.push_back(found);
        // It is told late where it had to be shared first. Light is sampled from one vertex before it.
        const auto end = static_cast<size_t>(found.edges);
        const size_t vertex = found.technique == Technique::light_sampling ? end - 1 : end;
        path.vertices[vertex - 1].contributions.push_back(found);
    }

    PathRecord path;

  private:
    PathVertex& here() { return path.vertices[here_]; }

    size_t here_ = 0;
    vec3 throughput_{1};
};

}  // namespace

PathRecord replay(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, uint32_t x,
                  uint32_t y, uint64_t index, bool with_lights, int threads) {
    const FlushDenormals flush;  // as while rendering
    PathRecord record;
    LightImage light(scene, sensor, algorithm);
    TileWorkers workers(thread_count(threads));
    if (with_lights) light.trace(workers, index, index + 1, [] { return false; });
    SampleBatch<Recorder> batch(scene, sensor, algorithm, light);
    const Tiles tiles(sensor.camera.width(), sensor.camera.height());
    batch.add(tiles[tiles.index_of(x, y)], x, y, index);
    batch.finish([&](const auto& sample) {
        record = sample.listener.path;
        record.radiance = sample.radiance;
    });
    return record;
}

}  // namespace etendue
