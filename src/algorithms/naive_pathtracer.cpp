// Naive path tracing (assignment 1): bounce by the BSDF until a light is found by chance.
//
//     L = sum over vertices of  throughput x Le,    throughput = product of f cos / pdf
//
// The baseline that the other estimators are measured against: no light is ever looked for, so small lamps
// are rarely found.
#include "algorithms/russian_roulette.h"

namespace etendue {

namespace {

class NaivePathtracer : public Algorithm {
  public:
    explicit NaivePathtracer(const Parameters& parameters)
        : MAX_CAM_PATH_LENGTH(parameters.get<int>("max_cam_path_length")), roulette_(parameters) {}

    vec3 radiance(Context& context, Ray ray) const override {
        vec3 radiance(0), throughput(1);
        float eta_scale = 1;
        for (int depth = 1;; ++depth) {
            const SurfaceHit hit = context.intersect(ray);
            if (hit.is_light()) {
                radiance += context.light({Technique::bsdf_sampling, depth, throughput * hit.Le()});
            }
            if (!hit.valid || depth == MAX_CAM_PATH_LENGTH) break;

            // Continue by the BSDF; on a lamp, which absorbs, there is nothing to continue with.
            context.sampler.start_vertex(depth);
            const auto bounce = context.bounce(hit);
            if (!bounce) break;
            throughput *= bounce->weight;
            eta_scale *= bounce->eta2;
            if (is_black(throughput)) break;

            if (!roulette_.survives(context, throughput, eta_scale, depth)) break;
            ray = hit.ray_towards(bounce->wi);
        }
        return radiance;
    }

    static std::vector<Parameter> parameters() {
        auto all = RussianRoulette::parameters();
        all.push_back(max_path_length_parameter());
        return all;
    }

  private:
    const int MAX_CAM_PATH_LENGTH;
    const RussianRoulette roulette_;
};

const Register<NaivePathtracer> registered{"NaivePathtracer",
                                           "path tracing that finds lights by chance alone (assignment 1)",
                                           NaivePathtracer::parameters()};

}  // namespace

}  // namespace etendue
