// The first sheet's renderer: what a ray hits, lit by a lamp at the eye.  No light transport; for looking at
// geometry, materials and normals.
#include "algorithms/algorithm.h"

namespace etendue {

namespace {

class SimpleRenderer : public PathByPath {
  public:
    explicit SimpleRenderer(const Parameters&) {}

    vec3 radiance(Context& context, Ray ray) const override {
        const SurfaceHit hit = context.intersect(ray);
        if (!hit.valid) return hit.Le();
        if (hit.material->emits() && hit.front) return hit.material->albedo_at(hit.uv());
        return hit.surface().albedo * std::abs(glm::dot(hit.wo, hit.frame.n));
    }
};

const Register<SimpleRenderer> registered{
    "SimpleRenderer", "albedo under a lamp at the eye, no light transport", {}, AlgorithmInfo::NO_TRANSPORT};

}  // namespace

}  // namespace etendue
