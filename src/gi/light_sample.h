// The contract of a light.  Each kind lives in a file of its own in lights/ and is found there by the build.
//
// All pdfs are in solid angle at the reference point; conversions happen in there, never in an estimator.
//     find       makes the lights of this kind that a scene has;
//     sample_Li  draws a direction to one triangle of the light's mesh, or to the sky, with density pdf_Li, and what
//                arrives if nothing is between; `with_mis` says that light which rays find by chance is counted
//                beside, so that what they find easily may be left to them;
//     Le         is what a ray that found the light by chance sees, and pdf_Li as said above;
//     power      is what lights are chosen by, with
//     bounds     of each triangle, where the light has a mesh.
#pragma once

#include <string_view>

#include "gi/hits.h"

namespace etendue {

struct Sky;

/// The scene as lights see it when they are made.
struct LightContext {
    std::span<const Mesh> meshes;
    std::span<const Material> materials;
    const Sky* sky;      // may be null
    float scene_radius;  // of the scene's bounding sphere
};

template <class F>
struct LightSampleOf {
    Mask<F> exists{false};  // else the light cannot shine on the reference point, and the rest means nothing
    Vec3<F> radiance{0};    // towards the reference point
    Vec3<F> wi{0};          // unit, from there to the light
    F pdf = 0;              // > 0
    SurfacePointOf<F> point;  // on the light; meaningless where `infinite`
    Mask<F> infinite{false};
};
using LightSample = LightSampleOf<float>;

/// Light that rays found by chance.
template <class F>
struct FoundLightOf {
    Vec3<F> radiance{0};  // towards where they came from
    F pdf = 0;            // of sampling that direction on purpose, once the light and its triangle are chosen
};

/// The ray that asks whether a light sample is visible from a point: between the two surfaces, each offset by its own
/// error.
template <class F>
RayOf<F> shadow_ray(const SurfacePointOf<F>& point, const LightSampleOf<F>& sample) {
    const Vec3<F> origin = point.offset_towards(sample.wi);
    // Ends short of the light by the error of the point there, and by the rounding of the difference itself.
    const Vec3<F> to_light = sample.point.offset_towards(-sample.wi) - origin;
    return {origin, select(sample.infinite, sample.wi, to_light),
            select(sample.infinite, F(INFINITE), F(1 - 4 * std::numeric_limits<float>::epsilon()))};
}

}  // namespace etendue
