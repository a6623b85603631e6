// Direct illumination by directions: one ray from the surface that is seen, either uniform over the sphere or
// importance sampled by the BSDF, and the light it happens to find.  The difference between the two is what
// importance sampling buys.
#include "algorithms/algorithm.h"

namespace etendue {

namespace {

class BRDFImportance : public Algorithm {
  public:
    explicit BRDFImportance(const Parameters& parameters)
        : MAX_CAM_PATH_LENGTH(parameters.get<int>("max_cam_path_length")),
          uniform_(parameters.get<std::string>("sampling") == "uniform") {}

    vec3 radiance(Context& context, Ray ray) const override {
        const SurfaceHit hit = context.intersect(ray);
        const vec3 emitted = hit.Le();
        if (!hit.valid || MAX_CAM_PATH_LENGTH < 2) return emitted;

        context.sampler.start_vertex(1);
        const float lobe = context.sampler.next_1d();
        const vec2 u = context.sampler.next_2d();
        // A delta lobe has no other directions than its own.
        if (uniform_ && !hit.is_type(BRDF_SPECULAR)) {
            const vec3 wi = uniform_sphere(u);
            const vec3 weight = hit.f(wi) * (std::abs(glm::dot(wi, hit.frame.n)) / UNIFORM_SPHERE_PDF);
            if (is_black(weight)) return emitted;
            return emitted + weight * context.intersect(hit.ray_towards(wi)).Le();
        }
        const auto bounce = hit.sample(lobe, u);
        if (!bounce) return emitted;
        return emitted + bounce->weight * context.intersect(hit.ray_towards(bounce->wi)).Le();
    }

  private:
    const int MAX_CAM_PATH_LENGTH;
    const bool uniform_;
};

const Register<BRDFImportance> registered{
    "BRDFImportance",
    "direct light by uniform or BSDF-sampled directions, paths of at most two edges",
    {max_path_length_parameter(),
     {"sampling", "how BRDFImportance draws directions", std::string("bsdf"), 0, 0, {"bsdf", "uniform"}}},
    AlgorithmInfo::DIRECT};

}  // namespace

}  // namespace etendue
