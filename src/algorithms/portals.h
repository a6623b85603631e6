// Light through windows: directions to smooth glass and mirrors, sampled on purpose where a path sees its first surface.
//
// No light can be sampled through glass, so a path finds the lamp or the sky behind a window by chance alone: as rarely as its
// bounce meets the window. Here a triangle of a delta surface is chosen by a light tree, in which triangles "shine" by their
// area, and a point of it evenly. If that is what the ray meets, it goes on over delta surfaces alone, by their BSDFs, as a path
// would; what shines at their end is found.
//
// The bounce x -> g has the density
//
//     p(g) = P(triangle | x) / area * |x - g|^2 / |cos_g|    in solid angle at x,
//
// and what follows has the same probabilities as after a bounce by the BSDF. So both find the same paths, those from x over
// delta surfaces to a light, and share them by the weights of multiple importance sampling, as light sampling does:
// p_bsdf(x -> g) and p(g). What is seen of a triangle's back was not meant, and has p = 0.
#pragma once

#include "algorithms/direct_light.h"

namespace etendue {

class Portals {
  public:
    static Parameter parameter() {
        return {"portals",
                "whether directions to smooth glass and mirrors are sampled at the first surface of each "
                "path, where that pays: light through windows",
                true,
                0,
                0,
                {}};
    }

    Portals() = default;
    /// All delta surfaces of a scene.
    explicit Portals(const Scene& scene);

    /// Of a sample.
    struct Light {
        LaneVec3 radiance{0};
        // By how much the variance of a path that finds the same light by chance is larger than that of both: of an integrand g,
        // the mean of g^2 (1 / p_bsdf - 1 / (p_bsdf + p)) over p.
        LaneVec3 gain{0};
    };
    /// What arrives over delta surfaces at the vertices that are `on`, whose paths have one edge, by one sample for each from the
    /// context's numbers, but those of vertex 1. Paths end with `max_edges` edges.
    Light light(LaneContext& context, const SurfaceHits& hits, const LaneMask& on, float max_edges,
                Mis mis) const;

    /// p of the delta surfaces that bounces from `from` have met, for those that are `on`; 0 for the others.
    Lanes pdfs(const LaneMask& on, const LaneVec3& from, const SurfaceHits& hits) const;

  private:
    struct Place {
        const Mesh* mesh;
        uint32_t triangle;
    };
    LightTree tree_;
    std::vector<Place> places_;    // of the tree's emitters
    std::vector<uint32_t> first_;  // emitter of each mesh
    const Mesh* meshes_ = nullptr;
};

}  // namespace etendue
