// Naive path tracing (assignment 1): bounce by the BSDF until a light is found by chance.
//
//     L = sum over vertices of  throughput x Le,    throughput = product of f cos / pdf
//
// The baseline that the other estimators are measured against: no light is ever looked for, so small lamps
// are rarely found.
#include "algorithms/lane_paths.h"
#include "algorithms/russian_roulette.h"

namespace etendue {

namespace {

class NaivePathtracer : public Algorithm {
  public:
    explicit NaivePathtracer(const Parameters& parameters)
        : MAX_CAM_PATH_LENGTH(static_cast<float>(parameters.get<int>("max_cam_path_length"))),
          roulette_(parameters) {}

    uint64_t estimate(const Scene& scene, SampleQueue& queue) const override {
        return follow<LanePaths>(scene, queue,
                                 [&](LaneContext& context, LanePaths& paths) { extend(context, paths); });
    }

    static std::vector<Parameter> parameters() {
        auto all = RussianRoulette::parameters();
        all.push_back(max_path_length_parameter());
        return all;
    }

  private:
    /// By an edge.
    void extend(LaneContext& context, LanePaths& paths) const {
        SurfaceHits hits = context.intersect(paths.rays, paths.alive, [] {});
        if (any(hits.is_light)) {
            const ContributionOf<Lanes> found{
                Technique::bsdf_sampling, paths.edges,
                paths.throughput * Light::found(hits.is_light, hits, false).radiance};
            paths.radiance += context.light(found, hits.is_light);
        }
        LaneMask goes_on = hits.valid && paths.edges < MAX_CAM_PATH_LENGTH;

        // Continue by the BSDF; on a lamp, which absorbs, there is nothing to continue with.
        hits.read_colours();
        context.sampler.start_vertex(paths.edges);
        const BsdfSampleOf<Lanes> bounce = context.bounce(hits, goes_on);
        goes_on = goes_on && bounce.exists;
        paths.throughput *= bounce.weight;
        paths.eta_scale *= bounce.eta2;
        goes_on = goes_on && !is_black(paths.throughput);
        paths.alive = roulette_.survives(context, paths.throughput, paths.eta_scale, paths.edges, goes_on);
        paths.rays = hits.rays_towards(bounce.wi);
        paths.edges += 1;
    }

    const float MAX_CAM_PATH_LENGTH;
    const RussianRoulette roulette_;
};

const Register<NaivePathtracer> registered{"NaivePathtracer",
                                           "path tracing that finds lights by chance alone (assignment 1)",
                                           NaivePathtracer::parameters()};

}  // namespace

}  // namespace etendue
