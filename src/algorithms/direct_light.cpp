#include "algorithms/direct_light.h"

namespace etendue {

ETENDUE_LANES_FLATTEN ConnectionOf<Lanes> connect_to_lights(LaneContext& context, const SurfaceHits& hits,
                                                            const LaneMask& on, const LaneVec3& throughput,
                                                            const Lanes& edges, LightSampler::Kind kind,
                                                            const PerLane<const LightFactors*>& learned,
                                                            Mis mis, float light_samples) {
    const LaneMask asks = on && !hits.is_delta;
    if (!any(asks)) return {};
    const PerLane<float> finer_digits = to_array(context.sampler.next_1d(asks));
    const LaneVec2 u = context.sampler.next_2d(asks);
    const PerLane<float> x = to_array(u.x);
    PerLane<double> numbers{};
    for_lanes(asks, [&](int i) { numbers[i] = light_number(x[i], finer_digits[i]); });
    const auto choices =
        context.scene.light_sampler().sample(kind, asks, hits.point.position, numbers, learned);
    PerLane<const Light*> lights{};
    PerLane<uint32_t> triangles{};
    PerLane<float> pmfs{}, remapped{};
    PerLane<bool> chosen{};
    for (int i = 0; i < LANES; ++i) {
        const auto& choice = choices[i];
        if (!choice) continue;
        chosen[i] = true;
        lights[i] = choice->light, triangles[i] = choice->triangle;
        pmfs[i] = choice->pmf, remapped[i] = choice->remapped;
    }
    const LightSampleOf<Lanes> samples = Light::sample_Li(
        mask_of(chosen), hits.point.position, lights, triangles, {lanes_of(remapped), u.y}, mis != Mis::none);
    return connection(hits.point, hits.frame.n, samples, light_samples * lanes_of(pmfs),
                      hits.values(samples.exists, samples.wi), throughput, edges, mis);
}

}  // namespace etendue
