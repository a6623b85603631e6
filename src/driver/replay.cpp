#include "driver/replay.h"

#include "driver/sample_batch.h"
#include "driver/tiles.h"

namespace etendue {

namespace {

class Recorder : public Observer {
  public:
    explicit Recorder(std::vector<PathVertex>& vertices) : vertices_(&vertices) {}

    void edge(const Ray& ray, const SurfaceHit& hit) override {
        vertices_->push_back({ray, hit, throughput_, {}, {}, {}, {}});
    }
    void shadow_ray(const Ray& ray, bool visible) override { here().shadow_rays.push_back({ray, visible}); }
    void bounce(const BsdfSample& sample) override {
        if (!sample.exists) return;
        here().bounce = sample;
        throughput_ *= sample.weight;
    }
    void roulette(float q, bool survived) override {
        here().roulette = {q, survived};
        if (survived) throughput_ /= 1 - q;
    }
    void contribution(const Contribution& found) override { here().contributions.push_back(found); }

  private:
    PathVertex& here() { return vertices_->back(); }

    std::vector<PathVertex>* vertices_;
    vec3 throughput_{1};
};

}  // namespace

PathRecord replay(const Scene& scene, const Sensor& sensor, const Algorithm& algorithm, uint32_t x,
                  uint32_t y, uint64_t index) {
    const FlushDenormals flush;  // as while rendering
    PathRecord record;
    SampleBatch<Recorder> batch(sensor);
    batch.add(x, y, index, Recorder(record.vertices));
    batch.estimate(algorithm, scene, [&](const auto& sample) { record.radiance = sample.radiance; });
    return record;
}

}  // namespace etendue
