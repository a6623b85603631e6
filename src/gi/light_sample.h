// The contract of a light.  Each kind lives in a file of its own in lights/ and is found there by the build.
//
// All pdfs are in solid angle at the reference point; conversions happen in there, never in an estimator.
//     find       makes the lights of this kind that a scene has;
//     sample_Li  draws a direction to one triangle of the light's mesh, or to the sky, with density pdf_Li, and what
//                arrives if nothing is between; `with_mis` says that light which rays find by chance is counted
//                beside, so that what they find easily may be left to them;
//     Le         is what a ray that found the light by chance sees;
//     power      is what lights are chosen by, with
//     bounds     of each triangle, where the light has a mesh.
#pragma once

#include <optional>
#include <string_view>

#include "gi/hit.h"

namespace etendue {

struct Sky;

/// The scene as lights see it when they are made.
struct LightContext {
    std::span<const Mesh> meshes;
    std::span<const Material> materials;
    const Sky* sky;      // may be null
    float scene_radius;  // of the scene's bounding sphere
};

struct LightSample {
    vec3 radiance;       // towards the reference point
    vec3 wi;             // unit, from there to the light
    float pdf;           // > 0
    SurfacePoint point;  // on the light; meaningless where `infinite`
    bool infinite;
};

}  // namespace etendue
