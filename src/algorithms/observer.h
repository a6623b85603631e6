// What an estimator tells about its paths to whoever wants to know: a replay, a picture by techniques.
//
// Nobody listens in an ordinary render.  An estimator that goes through Context has nothing to do for it but to
// say what light it found, and how.
#pragma once

#include "gi/bsdf.h"
#include "gi/light_sample.h"

namespace etendue {

/// How a path found its light: on purpose, or by chance, which includes what the camera sees.
enum class Technique : uint8_t { bsdf_sampling, light_sampling };
inline constexpr std::array<std::string_view, 2> TECHNIQUES{"bsdf_sampling", "light_sampling"};

/// Light that a path brought to the camera.
template <class F>
struct ContributionOf {
    Technique technique = Technique::bsdf_sampling;
    F edges = 0;            // length of the path
    Vec3<F> unweighted{0};  // as the technique alone would have it
    F weight = 1;           // of the technique among those that could have found the same path (MIS)
    // Of the last direction by this technique, in solid angle; 0: no density, as of a delta. Of light that could be traced from
    // its other end too: of film and direction together, see light_tracing.h.
    F pdf = 0;
    F other_pdf = 0;          // the same by the other technique
    bool borrowed = false;    // found by another pixel's path, see path_reuse.h
    bool from_light = false;  // found by a path from a light, see light_tracing.h
    bool by_portal = false;   // found beside the path, over delta surfaces, see portals.h
};
using Contribution = ContributionOf<float>;

class Observer {
  public:
    virtual ~Observer() = default;
    /// The path's next edge, and what is at its end.
    virtual void edge(const Ray& /*ray*/, const SurfaceHit& /*hit*/) {}
    virtual void shadow_ray(const Ray& /*ray*/, bool /*visible*/) {}
    /// The path has ended; what is told from now on is of its first surface.
    virtual void back_at_first() {}
    /// A look from the path's first surface at the second of another pixel's path, see path_reuse.h.
    virtual void reuse_ray(const Ray& /*ray*/, bool /*visible*/) {}
    /// A ray from the path's first surface to smooth glass, or from there on, see portals.h.
    virtual void portal_ray(const Ray& /*ray*/) {}
    /// How the path goes on, if it does.
    virtual void bounce(const BsdfSample& /*sample*/) {}
    /// Russian roulette was played, with `q` the probability to end the path here.
    virtual void roulette(float /*q*/, bool /*survived*/) {}
    virtual void contribution(const Contribution& /*contribution*/) {}
};

}  // namespace etendue
