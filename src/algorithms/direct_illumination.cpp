// Direct illumination by light sampling: lamps that are seen, and what one sampled light adds to the surface
// that is seen.
//
// Light over at most two edges.  At delta surfaces, where no light can be sampled, the second edge is the
// mirrored or refracted ray, so that the picture is that of every other estimator with a longest path of two.
#include "algorithms/direct_light.h"

namespace etendue {

namespace {

class DirectIllumination : public PathByPath {
  public:
    explicit DirectIllumination(const Parameters& parameters)
        : MAX_CAM_PATH_LENGTH(parameters.get<int>("max_cam_path_length")), light_choice_(parameters) {}

    bool learns(const Scene& scene) const override { return light_choice_.learns(scene); }
    bool prepare(const Preparation& preparation) override {
        return light_choice_.prepare(preparation, std::min(MAX_CAM_PATH_LENGTH, 2), Mis::none);
    }

    vec3 radiance(Context& context, Ray ray) const override {
        const SurfaceHit hit = context.intersect(ray);
        const vec3 emitted = context.light({Technique::bsdf_sampling, 1, hit.Le()});
        if (!hit.valid || MAX_CAM_PATH_LENGTH < 2) return emitted;

        context.sampler.start_vertex(1);
        if (!hit.is_type(BRDF_SPECULAR)) {
            return emitted +
                   light_over(context, connect_to_light(context, hit, vec3(1), 2, light_choice_.kind(),
                                                        light_choice_.learned(hit), Mis::none));
        }
        const BsdfSample bounce = context.bounce(hit);
        if (!bounce.exists) return emitted;
        const vec3 reflected = bounce.weight * context.intersect(hit.ray_towards(bounce.wi)).Le();
        return emitted + context.light({Technique::bsdf_sampling, 2, reflected});
    }

  private:
    const int MAX_CAM_PATH_LENGTH;
    LightChoice light_choice_;
};

const Register<DirectIllumination> registered{"DirectIllumination",
                                              "direct light by light sampling, paths of at most two edges",
                                              {max_path_length_parameter(), LightChoice::parameter()},
                                              AlgorithmInfo::DIRECT};

}  // namespace

}  // namespace etendue
