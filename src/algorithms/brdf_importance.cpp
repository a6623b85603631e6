// Direct illumination by directions: one ray from the surface that is seen, either uniform over the sphere or
// importance sampled by the BSDF, and the light it happens to find.  The difference between the two is what
// importance sampling buys.
#include "algorithms/algorithm.h"

namespace etendue {

namespace {

class BRDFImportance : public PathByPath {
  public:
    explicit BRDFImportance(const Parameters& parameters)
        : MAX_CAM_PATH_LENGTH(parameters.get<int>("max_cam_path_length")),
          uniform_(parameters.get<std::string>("sampling") == "uniform") {}

    vec3 radiance(Context& context, Ray ray) const override {
        const SurfaceHit hit = context.intersect(ray);
        const vec3 emitted = context.light({Technique::bsdf_sampling, 1, hit.Le()});
        if (!hit.valid || MAX_CAM_PATH_LENGTH < 2) return emitted;

        context.sampler.start_vertex(1);
        const auto [wi, weight] = direction(context, hit);
        if (is_black(weight)) return emitted;
        const vec3 reflected = weight * context.intersect(hit.ray_towards(wi)).Le();
        return emitted + context.light({Technique::bsdf_sampling, 2, reflected});
    }

  private:
    struct Direction {
        vec3 wi, weight;  // f |cos| / pdf
    };
    Direction direction(Context& context, const SurfaceHit& hit) const {
        // A delta lobe has no other directions than its own.
        if (uniform_ && !hit.is_type(BRDF_SPECULAR)) {
            const vec3 wi = uniform_sphere(context.sampler.next_2d());
            return {wi, hit.f(wi) * (std::abs(glm::dot(wi, hit.frame.n)) / UNIFORM_SPHERE_PDF)};
        }
        const BsdfSample bounce = context.bounce(hit);
        return bounce.exists ? Direction{bounce.wi, bounce.weight} : Direction{};
    }

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
